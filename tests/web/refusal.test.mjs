// What the page says when something is refused.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { BINARY, drop, open_page, ready_to_run, run_to_end, start_browser, start_other_origin,
    start_server } from './page.mjs';
import { broken_ply, sphere_ply } from './shapes.mjs';

const help = spawnSync(BINARY, ['--help'], { encoding: 'utf8' }).stdout;
const without = (flag) => (help.includes(flag) ? false : `this server has no ${flag}`);

let browser;
before(async () => { browser = await start_browser(); });
after(() => browser?.close());

async function fault_of(page) {
    await page.waitForSelector('#fault h2', { timeout: 20_000 });
    return page.textContent('#fault');
}

test('the reasons of the server are shown', async () => {
    const server = await start_server();
    const page = await open_page(await browser.newContext(), server.url);
    try {
        await page.waitForSelector('.process');
        await drop(page, { name: 'broken.ply', bytes: broken_ply() });
        assert.match(await fault_of(page), /1000/, 'the count that is claimed is named');

        await drop(page, { name: 'letter.txt', bytes: Buffer.from('Dear all,') });
        await page.waitForFunction(() => /PLY/.test(document.getElementById('fault').textContent));

        await drop(page, { name: 'ball.ply', bytes: sphere_ply(2000) });
        await ready_to_run(page);
        assert.equal(await page.textContent('#fault'), '', 'a new start clears the message');
        await page.click('#parameters summary');
        await page.fill('#input-atoms', '-4');
        await page.click('#run');
        assert.match(await fault_of(page), /atoms must be an integer from 1 to 256/);
        assert.equal(await page.getAttribute('#input-atoms', 'aria-invalid'), 'true');
        assert.equal(await page.evaluate(() => document.activeElement.id), 'input-atoms');
    } finally {
        await server.stop();
    }
});

test('a server that is not there is named', async () => {
    const origin = await start_other_origin();
    try {
        const page = await open_page(await browser.newContext(),
            `${origin.url}/?server=http://127.0.0.1:9`);
        assert.match(await fault_of(page), /127\.0\.0\.1:9 cannot be reached/);
    } finally {
        origin.stop();
    }
});

test('without permission for its origin the page says so', async () => {
    const [server, origin] = [await start_server(), await start_other_origin()];
    try {
        const page = await open_page(await browser.newContext(), `${origin.url}/?server=${server.url}`);
        const text = await fault_of(page);
        assert.ok(text.includes(`does not allow pages from ${origin.url}`), text);
    } finally {
        origin.stop();
        await server.stop();
    }
});

test('from an origin that is allowed, everything works', { skip: without('--cors-origin') }, async () => {
    const origin = await start_other_origin();
    const server = await start_server('--cors-origin', origin.url);
    try {
        const page = await open_page(await browser.newContext(), `${origin.url}/?server=${server.url}`);
        await page.waitForSelector('.process');
        await drop(page, { name: 'ball.ply', bytes: sphere_ply(4000) });
        await run_to_end(page);
        const waiting = page.waitForEvent('download');
        await page.click('[data-download="points?format=ply"]');
        assert.match((await waiting).suggestedFilename(), /\.ply$/);
    } finally {
        origin.stop();
        await server.stop();
    }
});

test('a key is asked for, and opens the service', { skip: without('--api-key-file') }, async () => {
    const folder = mkdtempSync(join(tmpdir(), 'lpf-key-'));
    const key = 'a-key-of-the-tests-0123456789abcdef';
    const hash = createHash('sha256').update(key).digest('hex');
    writeFileSync(join(folder, 'keys'), `tests:${hash}\n`, { mode: 0o600 });
    const server = await start_server('--api-key-file', join(folder, 'keys'));
    try {
        const page = await open_page(await browser.newContext(), server.url);
        await page.waitForSelector('#connection[open]');
        assert.match(await page.textContent('#connection-state'), /\S/);
        await page.fill('#key', key);
        await page.click('#connection [type=submit]');
        await page.waitForSelector('.process');
        await drop(page, { name: 'ball.ply', bytes: sphere_ply(4000) });
        await run_to_end(page);
        const waiting = page.waitForEvent('download');
        await page.click('[data-download="points?format=drc"]');
        assert.equal((await waiting).suggestedFilename(), 'ball-points.drc');
        assert.equal(await page.evaluate(() => JSON.stringify(localStorage).includes('a-key')), false);
    } finally {
        await server.stop();
        rmSync(folder, { recursive: true });
    }
});
