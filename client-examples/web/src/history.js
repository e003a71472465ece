const NAME = 'lpf-jobs';
const MOST = 30;

/**
 * Jobs that were started here: they survive a reload. The server is asked for their state.
 * @typedef {{id: string, server: string, process: string, file: string, created: string}} Entry
 */

/** @returns {Entry[]} newest first */
export function stored_jobs() {
    try {
        return JSON.parse(localStorage.getItem(NAME)) ?? [];
    } catch {
        return [];  // written by somebody else, or storage is switched off
    }
}

function store(entries) {
    try {
        localStorage.setItem(NAME, JSON.stringify(entries.slice(0, MOST)));
    } catch {
        // Without storage the list lasts as long as the page.
    }
}

/** @param {Entry} entry */
export function remember_job(entry) {
    store([entry, ...stored_jobs().filter(({ id }) => id !== entry.id)]);
}

/** @param {string} id */
export function forget_job(id) {
    store(stored_jobs().filter((entry) => entry.id !== id));
}
