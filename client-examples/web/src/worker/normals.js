import { quantile } from '../numbers.js';
import { KdTree } from './kd_tree.js';

const NEIGHBOURS = 14;
const SPACING_RANK = 4;  // in a plane, the distance of this neighbour is about the spacing

/** Upper half of the covariance of some points: xx xy xz yy yz zz. */
function covariance(points, indices) {
    const mean = [0, 0, 0];
    for (const i of indices) for (let c = 0; c < 3; ++c) mean[c] += points[i * 3 + c] / indices.length;
    const sum = [0, 0, 0, 0, 0, 0];
    for (const i of indices) {
        const [x, y, z] = mean.map((m, c) => points[i * 3 + c] - m);
        sum[0] += x * x;
        sum[1] += x * y;
        sum[2] += x * z;
        sum[3] += y * y;
        sum[4] += y * z;
        sum[5] += z * z;
    }
    return sum;
}

/** Smallest eigenvalue of a symmetric matrix, by the cosine formula for its cubic. */
function smallest_eigenvalue([xx, xy, xz, yy, yz, zz]) {
    const mean = (xx + yy + zz) / 3;
    const [a, b, c] = [xx - mean, yy - mean, zz - mean];
    const p = Math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6);
    if (p === 0) return mean;
    const det = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / p ** 3;
    const angle = Math.acos(Math.min(1, Math.max(-1, det / 2))) / 3;
    return mean + 2 * p * Math.cos(angle + 2 * Math.PI / 3);
}

/** Direction in which points spread least; [0, 0, 0] where there is none. */
function least_direction(matrix) {
    const least = smallest_eigenvalue(matrix);
    const [xx, xy, xz, yy, yz, zz] = matrix;
    const rows = [[xx - least, xy, xz], [xy, yy - least, yz], [xz, yz, zz - least]];
    let best = [0, 0, 0];
    let size = 0;
    for (const [a, b] of [[0, 1], [0, 2], [1, 2]]) {
        const [u, v] = [rows[a], rows[b]];
        const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        const length = Math.hypot(...n);
        if (length > size) [best, size] = [n.map((x) => x / length), length];
    }
    return best;
}

function distance(points, i, j) {
    return Math.hypot(...[0, 1, 2].map((c) => points[i * 3 + c] - points[j * 3 + c]));
}

/**
 * What is needed to draw points as a surface.
 * @param {import('./cloud.js').Cloud} cloud
 * @returns {{normals: Int8Array, spacing: number}} normals: xyz of each point, 127 being 1, of
 *     either sign: the direction in which the neighbours spread least. spacing: how far from each
 *     other points lie, typically
 */
export function estimate_surface({ positions, count }) {
    const tree = new KdTree(positions);
    const normals = new Int8Array(count * 3);
    const gaps = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
        const near = tree.nearest_k(positions[i * 3], positions[i * 3 + 1], positions[i * 3 + 2],
            NEIGHBOURS).filter((index) => index >= 0);
        const n = least_direction(covariance(positions, near));
        for (let c = 0; c < 3; ++c) normals[i * 3 + c] = Math.round(127 * n[c]);
        gaps[i] = distance(positions, i, near[Math.min(SPACING_RANK, near.length - 1)]);
    }
    return { normals, spacing: quantile(gaps, 0.5) };
}
