// The whole way of a user: from dropping a file to finding the job again after a reload.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { drawn_share, drop, open_page, ready_to_run, run_to_end, start_browser, start_server,
    until } from './page.mjs';
import { sphere_ply } from './shapes.mjs';

let server;
let browser;
let page;

before(async () => {
    server = await start_server();
    browser = await start_browser();
    const context = await browser.newContext({ viewport: { width: 1100, height: 720 } });
    page = await open_page(context, server.url);
});

after(async () => {
    await browser?.close();
    await server?.stop();
});

test('a dropped file is drawn at once and sent', async () => {
    await page.waitForSelector('.process');
    await drop(page, { name: 'ball.ply', bytes: sphere_ply(12_000) });
    await ready_to_run(page);
    assert.match(await page.textContent('#shape'), /ball\.ply12,000 points/);
    await page.waitForFunction(() => document.getElementById('stage').classList.contains('has-shape'));
    const share = await drawn_share(page);
    assert.ok(share > 0.1, `only ${share} of the view is drawn`);
});

test('every input of the server has a control, and its automatic value is explained', async () => {
    const process = await (await fetch(`${server.url}/v1/processes/denoise`)).json();
    const wanted = Object.keys(process.inputs).filter((name) => name !== 'shape').sort();
    const shown = await page.$$eval('.parameter', (rows) => rows.map((row) => row.dataset.name).sort());
    assert.deepEqual(shown, wanted);
    await page.click('#parameters summary');
    assert.match(await page.textContent('[data-name=radius] .auto'), /\S/);
    await page.fill('#input-analysisIterations', '2');
});

test('progress moves, and the result is drawn beside the input', async () => {
    await page.evaluate(() => {
        window.seen = [];
        const bar = document.getElementById('progress-bar');
        new MutationObserver(() => window.seen.push(bar.value)).observe(bar, { attributes: true });
    });
    await run_to_end(page);
    const seen = await page.evaluate(() => window.seen);
    assert.ok(new Set(seen).size >= 2, `progress was ${seen}`);
    assert.deepEqual(seen, [...seen].sort((a, b) => a - b), 'progress went back');
    assert.equal(await page.isChecked('input[value=compare]'), true);
    assert.match(await page.textContent('#panel-result'), /12,000 → 12,000/);
    assert.ok(await drawn_share(page, { from: 0.1, to: 0.45 }) > 0.1, 'nothing before');
    assert.ok(await drawn_share(page, { from: 0.55, to: 0.9 }) > 0.1, 'nothing after');
    assert.equal(await page.locator('.plot circle').count(), 6, 'two iterations of three steps');
});

test('the divider is dragged and moved by keys', async () => {
    const divider = page.locator('#divider');
    const at = async () => Number(await divider.getAttribute('aria-valuenow'));
    const box = await divider.boundingBox();
    const before_drag = await page.locator('#canvas').screenshot();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x - 150, box.y + box.height / 2, { steps: 4 });
    await page.mouse.up();
    const dragged = await at();
    assert.ok(dragged < 45, `it stands at ${dragged} %`);
    assert.notDeepEqual(await page.locator('#canvas').screenshot(), before_drag);
    await divider.press('ArrowRight');
    assert.equal(await at(), dragged + 2);
    await divider.press('Home');
    assert.equal(await at(), 2);
});

test('colours can be chosen, with a legend', async () => {
    await page.check('input[value=after]', { force: true });
    const plain = await page.locator('#canvas').screenshot();
    for (const mode of ['displacement', 'rgb', 'attribute:intensity', 'dimension']) {
        await page.selectOption('#color', mode);
        await page.waitForFunction((wanted) =>
            wanted === 'rgb' || !document.getElementById('legend').hidden, mode);
        await page.waitForTimeout(300);
        assert.notDeepEqual(await page.locator('#canvas').screenshot(), plain, mode);
    }
    assert.match(await page.textContent('#legend'), /surface/);
});

test('the view turns and zooms by keys', async () => {
    const canvas = page.locator('#canvas');
    await canvas.press('0');
    await page.waitForTimeout(1000);
    const first = await canvas.screenshot();
    const looks_as_first = async () => first.equals(await canvas.screenshot());
    await canvas.press('ArrowLeft');
    await canvas.press('+');
    await until(async () => !await looks_as_first(), 'the picture changes');
    await canvas.press('0');
    await until(looks_as_first, '0 brings back the first look');
});

test('the dictionary shows every atom by usage, and lights one up', async () => {
    await page.click('#tab-dictionary');
    const names = await page.$$eval('.atom', (atoms) => atoms.map((atom) => atom.textContent));
    const usage = names.map((name) => parseFloat(/by ([\d.]+) %/.exec(name)[1]));
    assert.equal(names.length, 16);
    assert.deepEqual(usage, [...usage].sort((a, b) => b - a));
    const inked = await page.$$eval('.atom canvas', (all) => all.map((canvas) => canvas.getContext('2d')
        .getImageData(0, 0, canvas.width, canvas.height).data.filter((v, i) => i % 4 === 3 && v).length));
    assert.ok(Math.min(...inked) > 1000, `pixels of the atoms: ${inked}`);
    await page.click('.atom');
    assert.equal(await page.getAttribute('.atom', 'aria-pressed'), 'true');
    await page.waitForFunction(() => /^Use of atom/.test(document.getElementById('legend').textContent));
    await page.click('.atom');
    assert.equal(await page.inputValue('#color'), 'plain');
});

test('points are downloaded as PLY and as Draco', async () => {
    await page.click('#tab-result');
    for (const [format, magic] of [['ply', 'ply\n'], ['drc', 'DRACO']]) {
        const waiting = page.waitForEvent('download');
        await page.click(`[data-download="points?format=${format}"]`);
        const download = await waiting;
        const bytes = readFileSync(await download.path());
        assert.equal(bytes.toString('latin1', 0, magic.length), magic);
        assert.ok(bytes.length > 10_000);
    }
});

test('a Draco file is drawn, with nothing refused by the policy of the page', async () => {
    const { jobs } = await (await fetch(`${server.url}/v1/jobs`)).json();
    const answer = await fetch(`${server.url}/v1/jobs/${jobs[0].jobID}/results/points?format=drc`);
    await drop(page, { name: 'ball.drc', bytes: Buffer.from(await answer.arrayBuffer()) });
    await ready_to_run(page);
    await page.waitForTimeout(500);
    assert.ok(await drawn_share(page) > 0.1);
    assert.deepEqual(page.faults, []);
});

test('a second job is cancelled', async () => {
    await drop(page, { name: 'long.ply', bytes: sphere_ply(60_000) });
    await ready_to_run(page);
    await page.check('input[value=analyze]');
    await page.fill('#input-analysisIterations', '400');
    await page.click('#run');
    await page.waitForFunction(() => /Analysing/.test(document.getElementById('progress-title').textContent));
    await page.click('#cancel');
    await page.waitForSelector('#progress', { state: 'hidden', timeout: 10_000 });
    assert.equal(await page.textContent('#fault'), '');
    await page.waitForFunction(() => /cancelled/.test(document.getElementById('announcer').textContent));
});

test('after a reload the jobs are there, and a result can be opened again', async () => {
    await page.reload();
    await page.click('#tab-jobs');
    await page.waitForFunction(() => [...document.querySelectorAll('.state')]
        .map((state) => state.textContent).join() === 'dismissed,successful');
    await page.click('.job >> text=ball.ply');
    await page.waitForSelector('#panel-result .downloads');
    await page.waitForTimeout(500);
    assert.ok(await drawn_share(page, { from: 0.55, to: 0.9 }) > 0.1);
    assert.deepEqual(page.faults, []);
});
