import { is_missing_path, was_cancelled } from './api.js';
import { read_events } from './events.js';
import { Problem } from './problem.js';

const ENDS = new Set(['successful', 'failed', 'dismissed']);
const POLL_SECONDS = 1;
const RECONNECTS = 5;

const pause = (seconds) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));

export const job_path = (id, rest = '') => `/v1/jobs/${id}${rest}`;
export const has_ended = (info) => ENDS.has(info.status);

/** A random name for a request, so that sending it twice starts one job. */
function random_key() {
    const bytes = crypto.getRandomValues(new Uint8Array(16));
    return Array.from(bytes, (b) => b.toString(16).padStart(2, '0')).join('');
}

/** @returns {Promise<object>} the statusInfo of a new job */
export function start_job(api, process, inputs, signal) {
    return api.post(`/v1/processes/${process}/execution`, { inputs },
        { signal, headers: { 'Idempotency-Key': random_key() } });
}

/** @returns {Promise<void>} once the server has taken the job back */
export async function cancel_job(api, id) {
    await api.request(job_path(id), { method: 'DELETE' });
}

/** One connection to the event stream; returns the id of the last event. */
async function follow_events(api, id, after, info, update, signal) {
    const headers = { Accept: 'text/event-stream', ...(after && { 'Last-Event-ID': after }) };
    const response = await api.request(job_path(id, '/events'), { headers, signal });
    if (!response.headers.get('Content-Type')?.startsWith('text/event-stream')) {
        throw new Problem({ status: 501, title: 'This server has no event stream' });
    }
    for await (const event of read_events(response)) {
        after = event.id ?? after;
        if (!['status', 'progress', 'end'].includes(event.name)) continue;
        const news = JSON.parse(event.data);
        if (news.updated < info.updated) continue;  // a new reader is told the story so far
        Object.assign(info, news);
        update(info);
        if (has_ended(info)) return after;
    }
    return after;
}

/** Asks for the state until the job ends: held back by the server, or with pauses of ours. */
async function follow_by_polling(api, id, info, update, signal) {
    while (!has_ended(info)) {
        const response = await api.request(job_path(id),
            { signal, headers: { Prefer: `wait=${POLL_SECONDS}` } });
        Object.assign(info, await response.json());
        update(info);
        const held = response.headers.get('Preference-Applied');
        if (!has_ended(info) && !held) await pause(POLL_SECONDS);
    }
}

/**
 * Follows a job to its end: by its event stream, and where there is none, by asking.
 * @param {import('./api.js').Api} api
 * @param {string} id
 * @param {(info: object) => void} update is told each new state
 * @param {AbortSignal} signal stops following; the job goes on
 * @returns {Promise<object>} its last statusInfo
 */
export async function follow_job(api, id, update, signal) {
    const info = await api.json(job_path(id), { signal });
    update(info);
    let after;
    for (let attempt = 0; attempt < RECONNECTS && !has_ended(info); ++attempt) {
        try {
            after = await follow_events(api, id, after, info, update, signal);
        } catch (error) {
            if (was_cancelled(error)) throw error;
            if (error instanceof Problem && !is_missing_path(error) && error.status) throw error;
            if (is_missing_path(error)) break;
        }
        if (!has_ended(info)) await pause(POLL_SECONDS);
    }
    await follow_by_polling(api, id, info, update, signal);
    return api.json(job_path(id), { signal });
}
