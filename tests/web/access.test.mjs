// Accessibility by axe-core: the rules of WCAG 2.2, levels A and AA, in every state of the page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { drop, open_page, ready_to_run, run_to_end, start_browser, start_server } from './page.mjs';
import { broken_ply, sphere_ply } from './shapes.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const LEVELS = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'];
const DESKTOP = { width: 1200, height: 760 };
const PHONE = { width: 390, height: 780 };

let server;
let browser;
before(async () => {
    server = await start_server();
    browser = await start_browser();
});
after(async () => {
    await browser?.close();
    await server?.stop();
});

/** What axe finds fault with, and whether the page is wider than its window. */
async function faults(page) {
    const found = await page.evaluate(async (levels) => {
        const { violations } = await window.axe.run({ runOnly: levels });
        return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) =>
            `${node.target} ${node.any[0]?.message ?? node.failureSummary}`).join('; ')}`);
    }, LEVELS);
    const wider = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    return wider > 0 ? [...found, `${wider} pixels wider than the window`] : found;
}

/** Brings the page into each of its states in turn. */
async function* states(page) {
    await page.waitForSelector('.process');
    yield 'start';
    await drop(page, { name: 'broken.ply', bytes: broken_ply() });
    await page.waitForSelector('#fault h2');
    yield 'error';
    await drop(page, { name: 'ball.ply', bytes: sphere_ply(40_000) });
    await ready_to_run(page);
    await page.click('#parameters summary');
    yield 'set up, with parameters';
    await page.check('input[value=analyze]');
    await page.fill('#input-analysisIterations', '900');
    await page.click('#run');
    await page.waitForSelector('#progress:not([hidden])');
    yield 'running';
    await page.click('#cancel');
    await page.waitForSelector('#progress', { state: 'hidden' });
    await page.check('input[value=denoise]');
    await page.fill('#input-analysisIterations', '');
    await run_to_end(page);
    yield 'result';
    await page.selectOption('#color', 'displacement');
    await page.click('#tab-dictionary');
    await page.click('.atom');
    yield 'dictionary';
    await page.click('#tab-jobs');
    await page.waitForSelector('.job');
    yield 'jobs';
    await page.click('#connect');
    yield 'connection';
}

for (const [colorScheme, size] of [['dark', DESKTOP], ['light', DESKTOP], ['light', PHONE]]) {
    test(`no violation: ${colorScheme}, ${size.width} pixels wide`, async () => {
        // The page's own policy forbids scripts from elsewhere; axe is not a part of the page.
        const context = await browser.newContext({ viewport: size, colorScheme, bypassCSP: true,
            reducedMotion: 'reduce' });
        const page = await open_page(context, server.url);
        await page.evaluate(axe);
        for await (const state of states(page)) {
            assert.deepEqual(await faults(page), [], `${state}, ${colorScheme}, ${size.width} wide`);
        }
        await context.close();
    });
}

test('the whole page is within reach of the keyboard', async () => {
    const page = await open_page(await browser.newContext({ viewport: DESKTOP }), server.url);
    await page.waitForSelector('.process');
    const met = new Set();
    for (let i = 0; i < 25; ++i) {
        await page.keyboard.press('Tab');
        met.add(await page.evaluate(() => {
            const at = document.activeElement;
            return at.id || at.dataset.sample || at.name || at.tagName;
        }));
    }
    for (const wanted of ['theme', 'connect', 'choose', 'cube', 'tab-setup', 'process']) {
        assert.ok(met.has(wanted), `${wanted} is not reached: ${[...met]}`);
    }
});
