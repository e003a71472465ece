// Takes the pictures of docs/guide.md from the running page: node pictures.mjs FOLDER
import { join } from 'node:path';
import { open_page, run_to_end, start_browser, start_server, ready_to_run } from './page.mjs';

const folder = process.argv[2];
const WINDOW = { width: 1200, height: 720 };
const PART = { width: 960, height: 600 };  // of which only the view is shown
const settle = (page) => page.waitForTimeout(2500);  // normals arrive a moment after the points

const server = await start_server();
const browser = await start_browser();

/** A page with a sample that was worked on. */
async function work_on(sample, viewport, { process = 'denoise', inputs = {} } = {}) {
    const context = await browser.newContext({ viewport, colorScheme: 'light', reducedMotion: 'reduce' });
    const page = await open_page(context, server.url);
    await page.waitForSelector('.process');
    await page.click(`[data-sample=${sample}]`);
    await ready_to_run(page);
    await page.check(`input[value=${process}]`);
    await page.evaluate(() => { document.getElementById('parameters').open = true; });
    for (const [name, value] of Object.entries(inputs)) {
        const field = page.locator(`#input-${name}`);
        if (await field.evaluate((at) => at.tagName) === 'SELECT') await field.selectOption(value);
        else await field.fill(value);
    }
    await run_to_end(page);
    await settle(page);
    return page;
}

/** Only the view, without its tools. */
async function take_view(page, name) {
    const hide = (hidden) => { document.querySelector('.tools').hidden = hidden; };
    await page.evaluate(hide, true);
    await page.locator('#stage').screenshot({ path: join(folder, `${name}.png`) });
    await page.evaluate(hide, false);
}

const whole = await work_on('cube', WINDOW);
await whole.screenshot({ path: join(folder, 'page.png') });
await whole.selectOption('#color', 'error');
await settle(whole);
await take_view(whole, 'error');
await whole.click('#tab-dictionary');
await whole.click('.atom');
await settle(whole);
await whole.check('input[value=after]', { force: true });
await settle(whole);
await whole.screenshot({ path: join(folder, 'dictionary.png') });
await whole.context().close();

for (const [name, radius] of [['small', '2.5'], ['large', '20']]) {
    const page = await work_on('cube', PART, { inputs: { radius, radiusUnit: 'spacing' } });
    await page.check('input[value=after]', { force: true });
    await settle(page);
    await take_view(page, `radius-${name}`);
    await page.context().close();
}
const auto = await work_on('cube', PART);
await auto.check('input[value=after]', { force: true });
await settle(auto);
await take_view(auto, 'radius-auto');
await auto.context().close();

const analysis = await work_on('cube', PART, { process: 'analyze' });
await take_view(analysis, 'dimension');

await browser.close();
await server.stop();
