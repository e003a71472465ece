import { read_ply_header } from './ply_header.js';
import { read_rows } from './ply_rows.js';

/**
 * What the page needs of the `fields` of a job: one local probing field (LPF) in each place.
 * @typedef {object} Fields
 * @property {Float64Array} seeds xyz triples
 * @property {Uint8Array} dimension 0 too few points, 1 curve, 2 surface
 * @property {Float32Array} residual in units of the radius
 * @property {Uint32Array} codeStart where the code of each LPF begins; one more than LPFs
 * @property {Uint16Array} atoms the atoms that the codes use
 * @property {Float32Array} coefficients how much of each
 */

/**
 * @param {Blob} file the `fields` result of a job
 * @returns {Promise<Fields>}
 */
export async function read_fields(file) {
    const header = await read_ply_header(file);
    const element = header.elements[0];
    element.start = header.bodyStart;
    const at = Object.fromEntries(element.properties.map((p, i) => [p.name, i]));
    const seeds = new Float64Array(element.count * 3);
    const dimension = new Uint8Array(element.count);
    const residual = new Float32Array(element.count);
    const codeStart = new Uint32Array(element.count + 1);
    const atoms = [];
    const coefficients = [];
    await read_rows(file, header, element, () => true, (values, row) => {
        seeds.set([values[at.x], values[at.y], values[at.z]], row * 3);
        dimension[row] = values[at.dimension];
        residual[row] = values[at.residual];
        for (const atom of values[at.atom_indices]) atoms.push(atom);
        for (const value of values[at.coefficients]) coefficients.push(value);
        codeStart[row + 1] = atoms.length;
    });
    return { seeds, dimension, residual, codeStart, atoms: new Uint16Array(atoms),
        coefficients: new Float32Array(coefficients) };
}
