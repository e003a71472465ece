import { by_id } from './dom.js';

const has_files = (event) => [...(event.dataTransfer?.types ?? [])].includes('Files');

/**
 * Takes files that are dropped anywhere on the page or chosen in a dialog.
 * @param {(file: File) => void} opened
 */
export function accept_files(opened) {
    const input = by_id('file');
    for (const id of ['choose', 'change']) by_id(id).addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
        if (input.files.length) opened(input.files[0]);
        input.value = '';
    });
    let inside = 0;  // a drag enters each element that it passes, and leaves the one before
    const mark = (change) => {
        inside = Math.max(0, change === 0 ? 0 : inside + change);
        document.body.classList.toggle('dropping', inside > 0);
    };
    addEventListener('dragenter', (event) => has_files(event) && mark(1));
    addEventListener('dragleave', (event) => has_files(event) && mark(-1));
    addEventListener('dragover', (event) => has_files(event) && event.preventDefault());
    addEventListener('drop', (event) => {
        mark(0);
        if (!event.dataTransfer?.files.length) return;
        event.preventDefault();
        opened(event.dataTransfer.files[0]);
    });
}
