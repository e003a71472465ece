import { quantile } from '../numbers.js';

/**
 * How strongly a shape uses each atom where it uses it much: the ninth decile of its coefficients,
 * with the sign that most of them have. 1 for an atom that is not used.
 * @param {import('../worker/fields.js').Fields} fields
 * @param {number} count of atoms
 * @returns {number[]}
 */
export function atom_strengths({ atoms, coefficients }, count) {
    const uses = Array.from({ length: count }, () => []);
    atoms.forEach((atom, i) => uses[atom].push(coefficients[i]));
    return uses.map((list) => {
        const sum = list.reduce((total, value) => total + value, 0);
        return (quantile(list.map(Math.abs), 0.9) || 1) * (sum < 0 ? -1 : 1);
    });
}
