// three's PLYLoader reads a whole file at once, into Float32 and without lists: it can neither
// sample ten million points, nor keep geographic coordinates, nor read sparse codes.
import { make_cloud } from './cloud.js';
import { read_ply_header } from './ply_header.js';
import { read_rows } from './ply_rows.js';

const COLORS = ['red', 'green', 'blue'];
const HIDDEN = new Set(['x', 'y', 'z', 'nx', 'ny', 'nz', 'alpha', ...COLORS]);
const MAX_ATTRIBUTES = 12;
const MAX_FACES = 400_000;

/** The vertex element, with the offset of its first row. */
function find_vertices(header) {
    let start = header.bodyStart;
    for (const element of header.elements) {
        if (element.name === 'vertex') return Object.assign(element, { start });
        if (element.stride === null || header.format === 'ascii') break;
        start += element.stride * element.count;
    }
    throw new Error('The points do not come first in this PLY file: there is no preview of it.');
}

function column_of(element, name) {
    return element.properties.findIndex((p) => p.name === name && !p.list);
}

function color_scale(element) {
    const type = element.properties[column_of(element, 'red')].type;
    if (type.startsWith('float') || type.startsWith('double')) return 255;
    return type.startsWith('ushort') || type === 'uint16' ? 1 / 257 : 1;
}

/** Typed arrays for the rows to come, and what fills them. */
function make_columns(element, room) {
    const xyz = ['x', 'y', 'z'].map((name) => column_of(element, name));
    if (xyz.some((c) => c < 0)) throw new Error('The points of this PLY file have no x, y and z.');
    const rgb = COLORS.map((name) => column_of(element, name));
    const points = new Float64Array(room * 3);
    const colors = rgb.every((c) => c >= 0) ? new Uint8ClampedArray(room * 3) : null;
    const scale = colors ? color_scale(element) : 1;
    const names = element.properties.filter((p) => !p.list && !HIDDEN.has(p.name));
    const scalars = names.slice(0, MAX_ATTRIBUTES).map((p) => [
        element.properties.indexOf(p), p.name, new Float32Array(room)]);
    const put = (i, values) => {
        for (let c = 0; c < 3; ++c) points[i * 3 + c] = values[xyz[c]];
        if (colors) for (let c = 0; c < 3; ++c) colors[i * 3 + c] = values[rgb[c]] * scale;
        for (const [column, , array] of scalars) array[i] = values[column];
    };
    return { points, colors, scalars, put };
}

/** What a preview says of itself: the offset of its coordinates, and how many points the whole has. */
function preview_facts({ comments }) {
    const after = (start) => comments.find((line) => line.startsWith(start))?.slice(start.length);
    const offset = after('offset ')?.split(' ').map(Number);
    const whole = Number(after('points of the whole: ')) || undefined;
    return whole ? { offset, whole } : { offset: [0, 0, 0] };
}

/** Triangles of a binary mesh that is drawn whole. */
async function read_faces(file, header, vertices) {
    const face = header.elements[header.elements.indexOf(vertices) + 1];
    const list = face?.properties.findIndex((p) => /^vertex_ind(ex|ices)$/.test(p.name)) ?? -1;
    const readable = header.format !== 'ascii' && vertices.stride !== null && list >= 0;
    if (!readable || face.name !== 'face' || face.count === 0 || face.count > MAX_FACES) return;
    face.start = vertices.start + vertices.stride * vertices.count;
    const index = [];
    await read_rows(file, header, face, () => true, (values) => {
        const corners = values[list];
        for (let i = 2; i < corners.length; ++i) index.push(corners[0], corners[i - 1], corners[i]);
    });
    return new Uint32Array(index);
}

/**
 * Reads a PLY file for drawing: all of it, or evenly spread points if it has more than maxPoints.
 * @param {Blob} file
 * @param {number} maxPoints
 * @returns {Promise<import('./cloud.js').Cloud>}
 */
export async function read_ply(file, maxPoints) {
    const header = await read_ply_header(file);
    const vertices = find_vertices(header);
    const step = Math.max(1, Math.ceil(vertices.count / maxPoints));
    const columns = make_columns(vertices, Math.ceil(vertices.count / step));
    let count = 0;
    const wants = step === 1 ? () => true : (row) => row % step === 0;
    const total = await read_rows(file, header, vertices, wants, (values) => {
        columns.put(count, values);
        if (Number.isFinite(columns.points[count * 3])) ++count;
    });
    const attributes = {};
    for (const [, name, array] of columns.scalars) attributes[name] = array.slice(0, count);
    const { offset, whole } = preview_facts(header);
    const cloud = make_cloud(columns.points.subarray(0, count * 3), {
        total: whole ?? total,
        colors: columns.colors && new Uint8Array(columns.colors.buffer).slice(0, count * 3),
        attributes,
        index: step === 1 && count === total ? await read_faces(file, header, vertices) : undefined,
    });
    cloud.origin = cloud.origin.map((value, c) => value + offset[c]);
    return cloud;
}
