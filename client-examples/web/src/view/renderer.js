import { BufferAttribute, BufferGeometry, DepthTexture, LinearSRGBColorSpace, Mesh, NearestFilter,
    OrthographicCamera, Scene, WebGLRenderTarget, WebGLRenderer } from 'three';
import { shade_material } from './materials.js';

/** One triangle that covers the picture. */
function full_picture(material) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    geometry.setAttribute('uv', new BufferAttribute(new Float32Array([0, 0, 2, 0, 0, 2]), 2));
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    return new Scene().add(mesh);
}

/** Draws scenes side by side into one picture, then shades it by depth. */
export class Renderer {
    /** @param {HTMLCanvasElement} canvas @throws if the browser has no WebGL */
    constructor(canvas) {
        this.gl_ = new WebGLRenderer({ canvas, antialias: false });
        this.gl_.outputColorSpace = LinearSRGBColorSpace;  // colours are shown as they are
        this.gl_.autoClear = false;
        this.target_ = new WebGLRenderTarget(1, 1, {
            minFilter: NearestFilter, magFilter: NearestFilter, depthTexture: new DepthTexture(1, 1) });
        this.material_ = shade_material();
        this.picture_ = full_picture(this.material_);
        this.flat_ = new OrthographicCamera();
    }

    /** @returns {number} device pixels of one CSS pixel */
    get pixelRatio() {
        return this.gl_.getPixelRatio();
    }

    resize(width, height) {
        const ratio = Math.min(devicePixelRatio, 2);
        this.gl_.setPixelRatio(ratio);
        this.gl_.setSize(width, height, false);
        this.target_.setSize(Math.round(width * ratio), Math.round(height * ratio));
    }

    /**
     * @param {{scene: Scene, from: number, to: number}[]} parts each from and to a share of the width
     * @param {import('three').PerspectiveCamera} camera
     * @param {import('three').Color} background
     */
    draw(parts, camera, background) {
        const { gl_: gl, target_: target } = this;
        target.scissorTest = false;
        gl.setRenderTarget(target);
        gl.clear();
        target.scissorTest = true;
        for (const { scene, from, to } of parts) {
            const left = Math.round(from * target.width);
            target.scissor.set(left, 0, Math.round(to * target.width) - left, target.height);
            gl.setRenderTarget(target);
            gl.render(scene, camera);
        }
        this.shade_(camera, background);
    }

    shade_(camera, background) {
        const { uniforms } = this.material_;
        const reach = 1.4 * this.pixelRatio;
        uniforms.picture.value = this.target_.texture;
        uniforms.depth.value = this.target_.depthTexture;
        uniforms.texel.value.set(reach / this.target_.width, reach / this.target_.height);
        uniforms.near.value = camera.near;
        uniforms.far.value = camera.far;
        uniforms.background.value.copy(background);
        this.gl_.setRenderTarget(null);
        this.gl_.render(this.picture_, this.flat_);
    }
}
