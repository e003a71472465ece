// What a visitor has to load.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { PAGE_DIR } from './page.mjs';

const files = readdirSync(PAGE_DIR, { recursive: true }).map(String);

test('all code together, decoder included, is below 1 MB compressed', () => {
    const code = files.filter((name) => /\.(js|wasm)$/.test(name));
    assert.ok(code.some((name) => name.endsWith('.wasm')), 'the decoder is part of it');
    const total = code.reduce((sum, name) =>
        sum + gzipSync(readFileSync(join(PAGE_DIR, name))).length, 0);
    console.log(`code compressed: ${(total / 1000).toFixed(0)} KB in ${code.length} files`);
    assert.ok(total < 1_000_000, `${total} bytes`);
});

test('nothing comes from another host', () => {
    const html = readFileSync(join(PAGE_DIR, 'index.html'), 'utf8');
    const styles = files.filter((name) => name.endsWith('.css'))
        .map((name) => readFileSync(join(PAGE_DIR, name), 'utf8')).join('');
    assert.doesNotMatch(html + styles, /(?:src|href|url)\s*[=(]\s*["']?(?:https?:)?\/\//);
    assert.doesNotMatch(html, /<script(?![^>]*src)|<style|\sstyle=|\son\w+=/, 'no inline code');
});
