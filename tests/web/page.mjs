// A server, a browser and what the tests do with the page again and again.
import { spawn } from 'node:child_process';
import { createReadStream, existsSync, mkdtempSync, rmSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { createInterface } from 'node:readline';
import { chromium } from 'playwright-core';
import { PNG } from 'pngjs';

export const BINARY = process.env.LPF_SERVER_BINARY;
export const PAGE_DIR = process.env.LPF_PAGE_DIR;
const CHROMIUM = process.env.LPF_CHROMIUM ?? '/usr/bin/chromium';

/** Starts the built server on free ports. @returns {Promise<{url: string, stop: Function}>} */
export async function start_server(...flags) {
    const folder = mkdtempSync(join(tmpdir(), 'lpf-web-'));
    const child = spawn(BINARY, ['--port', '0', '--admin-port', '0', '--data-dir', folder,
        '--disk-floor-bytes', '0', '--disk-floor-percent', '0', '--log-level', 'warn', ...flags],
    { stdio: ['ignore', 'pipe', 'inherit'] });
    const ended = new Promise((resolve) => child.once('exit', resolve));
    const ready = await new Promise((resolve, reject) => {
        createInterface(child.stdout).once('line', (line) => resolve(JSON.parse(line)));
        ended.then((code) => reject(new Error(`the server ended at once with exit code ${code}`)));
    });
    const stop = async () => {
        child.kill('SIGKILL');
        await ended;
        rmSync(folder, { recursive: true, force: true });
    };
    return { url: `http://127.0.0.1:${ready.port}`, stop };
}

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css',
    '.wasm': 'application/wasm', '.svg': 'image/svg+xml' };

/** Serves the page alone, from an origin of its own. */
export async function start_other_origin() {
    const server = createServer((request, response) => {
        const path = normalize(new URL(request.url, 'http://any').pathname);
        const file = join(PAGE_DIR, path === '/' ? 'index.html' : path);
        if (!existsSync(file)) return response.writeHead(404).end();
        response.writeHead(200, { 'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream',
            'Content-Length': statSync(file).size });
        return createReadStream(file).pipe(response);
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    return { url: `http://127.0.0.1:${server.address().port}`, stop: () => server.close() };
}

export function start_browser() {
    return chromium.launch({ executablePath: CHROMIUM, headless: true, args: ['--no-sandbox',
        '--disable-quic', '--no-first-run', '--disable-background-networking',
        '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
        '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'] });
}

/** Opens the page; `faults` collects what the browser complains of, policy breaches among it. */
export async function open_page(context, url) {
    const page = await context.newPage();
    page.faults = [];
    page.on('pageerror', (error) => page.faults.push(error.message));
    page.on('console', (message) => {
        if (/Content Security Policy|WebGL|THREE/.test(message.text())) page.faults.push(message.text());
    });
    await page.goto(url);
    return page;
}

/** Drops a file on the page as a user does. @param {{name: string, bytes: Buffer}} file */
export async function drop(page, { name, bytes }) {
    const data = await page.evaluateHandle(([file_name, base64]) => {
        const binary = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const transfer = new DataTransfer();
        transfer.items.add(new File([binary], file_name));
        return transfer;
    }, [name, bytes.toString('base64')]);
    await page.dispatchEvent('#stage', 'dragenter', { dataTransfer: data });
    await page.dispatchEvent('#stage', 'drop', { dataTransfer: data });
}

/** Waits until a condition holds: software rendering on a busy machine takes its time. */
export async function until(holds, what, seconds = 20) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
        if (await holds()) return;
        await new Promise((resolve) => setTimeout(resolve, 200));
    }
    throw new Error(`after ${seconds} s still not: ${what}`);
}

export const ready_to_run = (page) =>
    page.waitForFunction(() => !document.getElementById('run').disabled, null, { timeout: 30_000 });

/** Runs the process that is chosen and waits for its result. */
export async function run_to_end(page) {
    await ready_to_run(page);
    await page.click('#run');
    await page.waitForSelector('#panel-result .downloads', { timeout: 60_000 });
    await page.waitForSelector('#progress', { state: 'hidden' });
}

/** Share of the pixels of a part of the view that are not its background. */
export async function drawn_share(page, part = { from: 0, to: 1 }) {
    const box = await page.locator('#canvas').boundingBox();
    const clip = { x: box.x + box.width * part.from, y: box.y + 70,
        width: box.width * (part.to - part.from), height: box.height - 140 };
    const { data } = PNG.sync.read(await page.screenshot({ clip }));
    const view = await page.evaluate(() =>
        getComputedStyle(document.documentElement).getPropertyValue('--view').trim());
    const ground = [1, 3, 5].map((at) => parseInt(view.slice(at, at + 2), 16));
    let other = 0;
    for (let i = 0; i < data.length; i += 4) {
        if (ground.some((value, c) => Math.abs(value - data[i + c]) > 12)) ++other;
    }
    return other / (data.length / 4);
}
