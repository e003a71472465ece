import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { KdTree } from './kd_tree.js';

/** How far the origin of one cloud is from that of another. */
function shift(from, to) {
    return [0, 1, 2].map((c) => from.origin[c] - to.origin[c]);
}

function map_points(cloud, other, Type, value) {
    const [sx, sy, sz] = shift(cloud, other);
    const p = cloud.positions;
    const out = new Type(cloud.count);
    for (let i = 0; i < cloud.count; ++i) {
        out[i] = value(p[i * 3] + sx, p[i * 3 + 1] + sy, p[i * 3 + 2] + sz, i);
    }
    return out;
}

/** Exact distance to the triangles of a mesh. */
function mesh_distance(mesh) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(mesh.positions, 3));
    geometry.setIndex(new BufferAttribute(mesh.index, 1));
    const bvh = new MeshBVH(geometry);
    const query = new Vector3();
    const target = {};
    return (x, y, z) => bvh.closestPointToPoint(query.set(x, y, z), target).distance;
}

/**
 * Distance of each point to the nearest place of a reference: to its triangles if it has some,
 * else to its points.
 * @returns {Float32Array}
 */
export function distances_to(cloud, reference) {
    if (reference.index) return map_points(cloud, reference, Float32Array, mesh_distance(reference));
    const tree = new KdTree(reference.positions);
    return map_points(cloud, reference, Float32Array, (x, y, z) => tree.nearest(x, y, z).distance);
}

/** Distance between points of the same place in the order of two clouds. @returns {Float32Array} */
export function distances_in_order(cloud, other) {
    const q = other.positions;
    return map_points(cloud, other, Float32Array, (x, y, z, i) =>
        Math.hypot(x - q[i * 3], y - q[i * 3 + 1], z - q[i * 3 + 2]));
}

/** The nearest seed of each point of a cloud. @returns {Uint32Array} */
export function nearest_seeds(cloud, seeds) {
    const tree = new KdTree(seeds);
    return map_points(cloud, { origin: [0, 0, 0] }, Uint32Array,
        (x, y, z) => tree.nearest(x, y, z).index);
}
