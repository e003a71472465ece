const CHUNK_BYTES = 8 << 20;

/** Calls take(values) for each row of an ASCII element that `wants(row)`. */
async function ascii_rows(file, header, count, wants, take) {
    const reader = file.slice(header.bodyStart).stream().getReader();
    const decoder = new TextDecoder('latin1');
    let rest = '';
    let row = 0;
    while (row < count) {
        const { done, value } = await reader.read();
        const text = rest + (done ? '\n' : decoder.decode(value, { stream: true }));
        let start = 0;
        for (let end; row < count && (end = text.indexOf('\n', start)) >= 0; start = end + 1) {
            if (wants(row)) {
                const line = text.slice(start, end).trim();
                if (!line) continue;
                take(line.split(/\s+/).map(Number), row);
            } else if (end - start <= 1 && !text.slice(start, end).trim()) {
                continue;
            }
            ++row;
        }
        rest = text.slice(start);
        if (done) break;
    }
    await reader.cancel();
    return row;
}

function binary_reader(properties, little) {
    let offset = 0;
    const reads = properties.map((p) => {
        const at = offset;
        offset += p.bytes;
        return (view, start) => view[p.getter](start + at, little);
    });
    return (view, start, out) => {
        for (let i = 0; i < reads.length; ++i) out[i] = reads[i](view, start);
        return out;
    };
}

/** Rows of one length: only as much of the file is in memory as a chunk has. */
async function binary_rows(file, header, element, wants, take) {
    const read = binary_reader(element.properties, header.format.includes('little'));
    const values = new Array(element.properties.length);
    const perChunk = Math.max(1, Math.floor(CHUNK_BYTES / element.stride));
    const present = Math.floor((file.size - element.start) / element.stride);
    const count = Math.min(element.count, present);
    for (let first = 0; first < count; first += perChunk) {
        const last = Math.min(count, first + perChunk);
        const from = element.start + first * element.stride;
        const to = element.start + last * element.stride;
        const view = new DataView(await file.slice(from, to).arrayBuffer());
        for (let row = first; row < last; ++row) {
            if (wants(row)) take(read(view, (row - first) * element.stride, values), row);
        }
    }
    return count;
}

/** Rows with lists: a value that is an array. The element is read as a whole. */
async function list_rows(file, header, element, take) {
    const little = header.format.includes('little');
    const view = new DataView(await file.slice(element.start).arrayBuffer());
    let at = 0;
    const next = (type) => {
        const value = view[type.getter](at, little);
        at += type.bytes;
        return value;
    };
    const one = (p) => (p.list ? Array.from({ length: next(p.list) }, () => next(p)) : next(p));
    let row = 0;
    for (; row < element.count && at < view.byteLength; ++row) {
        take(element.properties.map(one), row);
    }
    return row;
}

/**
 * Goes through the rows of one element.
 * @param {Blob} file
 * @param {object} header from read_ply_header
 * @param {object} element with `start`, the offset of its first row (binary)
 * @param {(row: number) => boolean} wants which rows
 * @param {(values: Array, row: number) => void} take is given the values in the order of the
 *     properties; the array is used again for the next row
 * @returns {Promise<number>} how many rows there are
 */
export function read_rows(file, header, element, wants, take) {
    if (header.format === 'ascii') return ascii_rows(file, header, element.count, wants, take);
    if (element.stride !== null) return binary_rows(file, header, element, wants, take);
    return list_rows(file, header, element, (values, row) => wants(row) && take(values, row));
}
