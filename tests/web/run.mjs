// All tests of the page, one after the other: they share the cores with a server and a browser.
import { existsSync } from 'node:fs';
import { BINARY, PAGE_DIR } from './page.mjs';

for (const [what, path] of [['server', BINARY], ['page', `${PAGE_DIR}/index.html`]]) {
    if (path && existsSync(path)) continue;
    console.error(`The ${what} is not there: ${path}. Build the targets lpf-server and web.`);
    process.exit(1);
}
for (const name of process.argv.slice(2).length ? process.argv.slice(2)
    : ['size', 'journey', 'refusal', 'access', 'large']) await import(`./${name}.test.mjs`);
