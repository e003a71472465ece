// Five million points: the page must answer while they are read, sent and drawn.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { drawn_share, open_page, ready_to_run, start_browser, start_server } from './page.mjs';
import { sphere_ply } from './shapes.mjs';

const POINTS = 5_000_000;
const LONGEST_TASK = 200;  // milliseconds

let server;
let browser;
let folder;
before(async () => {
    folder = mkdtempSync(join(tmpdir(), 'lpf-large-'));
    writeFileSync(join(folder, 'large.ply'), sphere_ply(POINTS));
    server = await start_server();
    browser = await start_browser();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    rmSync(folder, { recursive: true, force: true });
});

test('no task over 200 ms on the main thread while 5 million points are loaded', async () => {
    const page = await open_page(await browser.newContext({ viewport: { width: 900, height: 640 } }), server.url);
    await page.waitForSelector('.process');
    // Over loopback all is sent before there is a progress to tell of.
    const tools = await page.context().newCDPSession(page);
    await tools.send('Network.emulateNetworkConditions',
        { offline: false, latency: 0, downloadThroughput: -1, uploadThroughput: 60e6 });
    await page.evaluate(() => {
        window.tasks = [];
        new PerformanceObserver((list) => {
            for (const { startTime, duration } of list.getEntries()) {
                window.tasks.push({ start: Math.round(startTime), duration: Math.round(duration) });
            }
        }).observe({ entryTypes: ['longtask'] });
        window.shares = new Set();
        const bar = document.getElementById('progress-bar');
        new MutationObserver(() => window.shares.add(bar.value)).observe(bar, { attributes: true });
    });
    await page.setInputFiles('#file', join(folder, 'large.ply'));
    await page.waitForFunction(() => document.getElementById('stage').classList.contains('has-shape'),
        null, { timeout: 60_000 });
    await ready_to_run(page);
    await page.waitForTimeout(3000);  // until its normals are there and it is drawn anew
    const { tasks, shares } = await page.evaluate(() => ({ tasks: window.tasks, shares: window.shares.size }));
    console.log(`long tasks [ms]: ${tasks.map(({ duration }) => duration).join(', ') || 'none'}; ` +
        `upload progress told ${shares} times`);
    assert.ok(tasks.every(({ duration }) => duration <= LONGEST_TASK), JSON.stringify(tasks));
    assert.ok(shares >= 3, 'the upload is seen to progress');
    assert.match(await page.textContent('#shape'), /5,000,000 points, 95 MB, 250,000 points drawn/);
    assert.ok(await drawn_share(page) > 0.1);
});
