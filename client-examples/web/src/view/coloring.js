import { in_background } from '../background.js';
import { quantile } from '../numbers.js';
import { DIMENSIONS, map_values, rgb, tints_of } from './color_maps.js';

const DIM = { dark: '#3a4254', light: '#c3c8d2' };
const PLAIN = {
    dark: { before: '#e8a26a', after: '#7cc4e8' }, light: { before: '#e0935c', after: '#56abd6' } };
const other = { before: 'after', after: 'before' };

/**
 * What can be coloured by.
 * @param {object} scene before and after are clouds or null; fields, reference if they are there;
 *     inOrder, whether the points of both come in one order; cache, a Map; theme
 * @returns {{id: string, label: string}[]}
 */
export function color_modes(scene) {
    const clouds = [scene.before, scene.after].filter(Boolean);
    const names = new Set(clouds.flatMap((cloud) => Object.keys(cloud.attributes)));
    return [
        { id: 'plain', label: 'Form only' },
        scene.before && scene.after && { id: 'displacement', label: 'Displacement' },
        scene.reference && { id: 'error', label: 'Distance to the reference' },
        clouds.some((cloud) => cloud.colors) && { id: 'rgb', label: 'Colour of the scan' },
        ...Array.from(names, (name) => ({ id: `attribute:${name}`, label: `Attribute: ${name}` })),
        scene.fields && { id: 'dimension', label: 'Local dimension' },
        scene.fields && { id: 'residual', label: 'Residual of the fields' },
        scene.atom !== null && { id: 'atom', label: `Use of atom ${scene.atom + 1}` },
    ].filter(Boolean);
}

/** Computes once for each cloud. */
function cached(scene, key, compute) {
    if (!scene.cache.has(key)) scene.cache.set(key, compute());
    return scene.cache.get(key);
}

function nearest_seeds(scene, side) {
    return cached(scene, `seeds:${side}`, () =>
        in_background('nearest_seeds', scene[side], scene.fields.seeds));
}

/** Absolute share that an atom has in the code of each field. */
export function use_of_atom(fields, atom) {
    const use = new Float32Array(fields.dimension.length);
    for (let field = 0; field < use.length; ++field) {
        for (let i = fields.codeStart[field]; i < fields.codeStart[field + 1]; ++i) {
            if (fields.atoms[i] === atom) use[field] = Math.abs(fields.coefficients[i]);
        }
    }
    return use;
}

async function at_points(scene, side, values) {
    const seeds = await nearest_seeds(scene, side);
    return Float32Array.from(seeds, (seed) => values[seed]);
}

/** The values that a mode shows on a side, or undefined. */
async function values_of(scene, side, mode) {
    const cloud = scene[side];
    if (mode === 'displacement') {
        const method = scene.inOrder ? 'distances_in_order' : 'distances_to';
        return cached(scene, `moved:${side}`, () => in_background(method,
            { ...cloud, index: undefined }, { ...scene[other[side]], index: undefined }));
    }
    if (mode === 'error') {
        return cached(scene, `error:${side}`, () =>
            in_background('distances_to', cloud, scene.reference));
    }
    if (mode === 'residual') return at_points(scene, side, scene.fields.residual);
    if (mode === 'atom') return at_points(scene, side, use_of_atom(scene.fields, scene.atom));
    return cloud.attributes[mode.slice('attribute:'.length)];
}

function plain(scene, side) {
    const color = rgb(PLAIN[scene.theme][side]);
    return tints_of(scene[side].count, () => color);
}

function rgb_tints(scene, side) {
    return scene[side].colors ?? plain(scene, side);
}

async function dimension_tints(scene, side) {
    const seeds = await nearest_seeds(scene, side);
    const colors = DIMENSIONS.map(({ color }) => rgb(color));
    return tints_of(seeds.length, (i) => colors[scene.fields.dimension[seeds[i]]] ?? colors[0]);
}

/** From where to where the colours go: one range for both sides. */
function range_of(lists, mode) {
    const all = lists.filter(Boolean);
    const high = Math.max(...all.map((values) => quantile(values, 0.98)));
    if (!mode.startsWith('attribute:')) return [0, high || 1];
    return [Math.min(...all.map((values) => quantile(values, 0.02))), high];
}

function root_mean_square(values) {
    return Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
}

function by_side(sides, list) {
    return Object.fromEntries(sides.map((side, i) => [side, list[i]]));
}

async function scalar_tints(scene, sides, mode) {
    const values = await Promise.all(sides.map((side) => values_of(scene, side, mode)));
    const range = range_of(values, mode);
    const map = { atom: scene.theme === 'dark' ? 'ember' : 'rust', displacement: 'heat', error: 'heat' }[mode] ?? 'sea';
    const dim = rgb(DIM[scene.theme]);
    const tints = values.map((list, i) => {
        if (!list) return plain(scene, sides[i]);
        const mapped = map_values(list, range, map);
        if (mode === 'atom') list.forEach((value, p) => value === 0 && mapped.set(dim, p * 3));
        return mapped;
    });
    const rms = mode === 'error' ? by_side(sides, values.map(root_mean_square)) : undefined;
    return { tints, legend: { range, map, rms } };
}

/**
 * @param {object} scene
 * @param {string} mode id of a mode
 * @returns {Promise<{tints: Object<string, Uint8Array>, legend: object}>} per side; what to explain
 */
export async function color(scene, mode) {
    const sides = ['before', 'after'].filter((side) => scene[side]);
    const simple = { plain, rgb: rgb_tints, dimension: dimension_tints }[mode];
    if (simple) {
        const tints = await Promise.all(sides.map((side) => simple(scene, side)));
        return { tints: by_side(sides, tints), legend: mode === 'dimension' ? { classes: DIMENSIONS } : {} };
    }
    const { tints, legend } = await scalar_tints(scene, sides, mode);
    return { tints: by_side(sides, tints), legend };
}
