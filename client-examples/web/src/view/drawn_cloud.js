import { BufferAttribute, BufferGeometry, Mesh, Points, Scene } from 'three';
import { mesh_material, point_material } from './materials.js';
import { quantile } from '../numbers.js';

const COVER = 1.05;  // diameter of a point in spacings: so few gaps that a surface is seen

/** A cloud (or mesh) in a scene of its own. */
export class DrawnCloud {
    /** @param {import('../worker/cloud.js').Cloud} cloud */
    constructor(cloud) {
        this.cloud = cloud;
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(cloud.positions, 3));
        this.tints_ = new BufferAttribute(new Uint8Array(cloud.count * 3), 3, true);
        geometry.setAttribute('tint', this.tints_);
        geometry.setAttribute('normal', new BufferAttribute(new Int8Array(cloud.count * 3), 3, true));
        if (cloud.index) geometry.setIndex(new BufferAttribute(cloud.index, 1));
        this.object = cloud.index
            ? new Mesh(geometry, mesh_material()) : new Points(geometry, point_material());
        this.object.frustumCulled = false;
        this.scene = new Scene().add(this.object);
        this.radius = this.reach_();
        this.size_ = this.radius * 0.4 * Math.sqrt(4 * Math.PI / Math.max(1, cloud.count));  // a guess
    }

    /**
     * @param {Uint8Array} tints red, green and blue of each point
     * @param {number} ambient share of the light that comes from everywhere
     */
    paint(tints, ambient) {
        this.object.material.uniforms.ambient.value = ambient;
        this.tints_.array.set(tints);
        this.tints_.needsUpdate = true;
    }

    /** @param {{normals: Int8Array, spacing: number}} surface what the worker has estimated */
    light({ normals, spacing }) {
        if (spacing > 0) this.size_ = spacing * COVER;
        this.object.geometry.setAttribute('normal', new BufferAttribute(normals, 3, true));
    }

    /** Lays the cloud where it is relative to the origin of another. */
    place(origin) {
        this.object.position.set(...this.cloud.origin.map((value, c) => value - origin[c]));
    }

    /** @param {number} focal pixels of a unit of length at distance 1 */
    set_size(focal, pixelRatio) {
        const { uniforms } = this.object.material;
        if (!uniforms.size) return;
        uniforms.size.value = this.size_ * focal;
        uniforms.pixelRatio.value = pixelRatio;
    }

    dispose() {
        this.object.geometry.dispose();
        this.object.material.dispose();
    }

    /** How far nearly all points are from the middle. */
    reach_() {
        const p = this.cloud.positions;
        const lengths = new Float32Array(this.cloud.count);
        for (let i = 0; i < lengths.length; ++i) {
            const [x, y, z] = [p[i * 3], p[i * 3 + 1], p[i * 3 + 2]];
            lengths[i] = Math.sqrt(x * x + y * y + z * z);  // hypot takes many times as long
        }
        return quantile(lengths, 0.995) || 1;
    }
}
