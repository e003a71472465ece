import { in_background } from './background.js';

/** More points than this are drawn as a sample. */
export const DRAWN_POINTS = innerWidth < 700 ? 100_000 : 250_000;
const WHOLE_BYTES = 16e6;

const shape_path = (id, rest) => `/v1/shapes/${id}${rest}`;

/** Reads the local file for a first look. Nothing if it cannot: the server may know better. */
async function first_look(file, show) {
    try {
        await show(await in_background('read_cloud', file, DRAWN_POINTS));
    } catch (error) {
        return error;
    }
    return null;
}

/**
 * Sends a file, and shows it while it travels.
 * @param {import('./api.js').Api} api
 * @param {File} file
 * @param {{show: (cloud: object) => Promise<void>, progress: (share: number) => void,
 *          signal: AbortSignal}} options
 * @returns {Promise<object>} the server's description of the shape
 */
export async function send_shape(api, file, { show, progress, signal }) {
    const look = first_look(file, show);
    const shape = await api.upload('/v1/shapes', file, { progress, signal });
    const fault = await look;
    if (fault) await show(await fetch_input(api, shape));
    return shape;
}

/**
 * Points of a shape that the server has: all if they are few, else the server's sample.
 * @returns {Promise<import('./worker/cloud.js').Cloud>}
 */
export async function fetch_input(api, shape) {
    if (is_drawn_whole(shape)) {
        return in_background('fetch_cloud', api.location(shape_path(shape.id, '/data')), DRAWN_POINTS);
    }
    const path = shape_path(shape.id, `/preview?maxPoints=${DRAWN_POINTS}`);
    return in_background('fetch_cloud', api.location(path), DRAWN_POINTS);
}

/** Whether the browser gets the whole file, with its attributes and triangles. */
export function is_drawn_whole({ points, bytes }) {
    return points <= DRAWN_POINTS && bytes <= WHOLE_BYTES;
}
