/** Bytes and DataView getter of each scalar type, under both of its names. */
const SCALARS = {
    char: [1, 'getInt8'], int8: [1, 'getInt8'], uchar: [1, 'getUint8'], uint8: [1, 'getUint8'],
    short: [2, 'getInt16'], int16: [2, 'getInt16'],
    ushort: [2, 'getUint16'], uint16: [2, 'getUint16'],
    int: [4, 'getInt32'], int32: [4, 'getInt32'], uint: [4, 'getUint32'], uint32: [4, 'getUint32'],
    float: [4, 'getFloat32'], float32: [4, 'getFloat32'],
    double: [8, 'getFloat64'], float64: [8, 'getFloat64'],
};
const HEADER_BYTES = 1 << 17;

function scalar(name) {
    const found = SCALARS[name];
    if (!found) throw new Error(`The PLY header names the type "${name}", which does not exist.`);
    return { type: name, bytes: found[0], getter: found[1] };
}

function property(words) {
    if (words[1] !== 'list') return { name: words[2], ...scalar(words[1]) };
    return { name: words[4], list: scalar(words[2]), ...scalar(words[3]) };
}

/** Where the header ends, or -1. */
function end_of_header(text) {
    const match = /(?:^|[\r\n])end_header[ \t]*(\r\n|\n|\r)/.exec(text);
    return match ? match.index + match[0].length : -1;
}

/**
 * Reads the header of a PLY file, and no more of it.
 * @param {Blob} file
 * @returns {Promise<{format: string, elements: object[], comments: string[],
 *     bodyStart: number}>} each element with
 *     name, count, properties and, if its rows are all of one length, `stride` in bytes
 */
export async function read_ply_header(file) {
    const bytes = new Uint8Array(await file.slice(0, HEADER_BYTES).arrayBuffer());
    const text = new TextDecoder('latin1').decode(bytes);
    const bodyStart = end_of_header(text);
    if (!text.startsWith('ply') || bodyStart < 0) {
        throw new Error('This is no PLY file: its header does not begin or end as one.');
    }
    const header = { format: '', elements: [], comments: [], bodyStart };
    for (const line of text.slice(0, bodyStart).split(/\r\n|\n|\r/)) {
        const words = line.trim().split(/\s+/);
        if (words[0] === 'format') header.format = words[1];
        if (words[0] === 'comment') header.comments.push(words.slice(1).join(' '));
        if (words[0] === 'element') {
            header.elements.push({ name: words[1], count: Number(words[2]), properties: [] });
        }
        if (words[0] === 'property') header.elements.at(-1)?.properties.push(property(words));
    }
    for (const element of header.elements) {
        const fixed = element.properties.every((p) => !p.list);
        element.stride = fixed ? element.properties.reduce((sum, p) => sum + p.bytes, 0) : null;
    }
    return header;
}
