import { Color, PerspectiveCamera } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { in_background } from '../background.js';
import { DrawnCloud } from './drawn_cloud.js';
import { orbit_by_keys } from './orbit_keys.js';
import { Renderer } from './renderer.js';

const START = [0.75, -1.55, 0.95];  // where the camera stands, in radii of the shape

/** The view: a cloud before and one after, both or one of them, in one space. */
export class Viewer {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        this.canvas_ = canvas;
        this.renderer_ = new Renderer(canvas);
        this.camera_ = new PerspectiveCamera(38, 1, 0.1, 100);
        this.camera_.up.set(0, 0, 1);
        this.clouds_ = { before: null, after: null };
        this.mode_ = 'before';
        this.split_ = 0.5;
        this.background_ = new Color();
        this.controls_ = new OrbitControls(this.camera_, canvas);
        this.controls_.enableDamping = true;
        this.controls_.dampingFactor = 0.15;
        this.controls_.addEventListener('change', () => this.redraw());
        orbit_by_keys(canvas, this.camera_, this.controls_, () => this.fit());
        new ResizeObserver(() => this.resize_()).observe(canvas.parentElement);
        this.resize_();
        this.warm_up_();
    }

    /** @param {'before'|'after'} side @param {import('../worker/cloud.js').Cloud|null} cloud */
    show(side, cloud) {
        this.clouds_[side]?.dispose();
        this.clouds_[side] = cloud && new DrawnCloud(cloud);
        const origin = (this.clouds_.before ?? this.clouds_.after)?.cloud.origin;
        for (const drawn of Object.values(this.clouds_)) drawn?.place(origin);
        this.redraw();
        if (cloud && !cloud.index) this.light_(this.clouds_[side]);
    }

    /** @returns {import('../worker/cloud.js').Cloud|undefined} */
    cloud(side) {
        return this.clouds_[side]?.cloud;
    }

    /**
     * @param {Uint8Array} tints red, green and blue of each point of a side
     * @param {number} ambient share of the light that comes from everywhere
     */
    paint(side, tints, ambient) {
        this.clouds_[side].paint(tints, ambient);
        this.redraw();
    }

    /** @param {'before'|'compare'|'after'} mode */
    set mode(mode) {
        this.mode_ = mode;
        this.redraw();
    }

    /** Where the divider stands: a share of the width. */
    set split(share) {
        this.split_ = share;
        this.redraw();
    }

    set background(color) {
        const [r, g, b] = color;
        this.background_.setRGB(r / 255, g / 255, b / 255);
        this.redraw();
    }

    /** Shows the whole shape from where the first look is taken. */
    fit() {
        const drawn = this.clouds_.before ?? this.clouds_.after;
        if (!drawn) return;
        const r = drawn.radius;
        const { camera_: camera } = this;
        const angle = Math.atan(Math.tan(camera.fov * Math.PI / 360) * Math.min(1, camera.aspect));
        const distance = 1.12 * r / Math.sin(angle);
        camera.position.set(...START).setLength(distance);
        camera.near = distance / 200;
        camera.far = distance * 20;
        camera.updateProjectionMatrix();
        this.controls_.target.set(0, 0, 0);
        this.controls_.minDistance = r / 50;
        this.controls_.maxDistance = distance * 10;
        this.controls_.update();
        this.redraw();
    }

    /** Draws before long; many calls make one picture. */
    redraw() {
        this.frame_ ??= requestAnimationFrame(() => {
            this.frame_ = undefined;
            this.controls_.update();
            this.draw_();
        });
    }

    /** The form of points shows once they have normals and a size, which take a moment. */
    async light_(drawn) {
        const { positions, count } = drawn.cloud;
        drawn.light(await in_background('estimate_surface', { positions, count }));
        this.redraw();
    }

    /** Has the programs of points and triangles compiled while nobody waits, and keeps them. */
    warm_up_() {
        const corner = { count: 3, origin: [0, 0, 0], positions: new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]) };
        this.kept_ = [new DrawnCloud(corner),
            new DrawnCloud({ ...corner, index: new Uint32Array([0, 1, 2]) })];
        const parts = this.kept_.map(({ scene }) => ({ scene, from: 0, to: 1 }));
        this.renderer_.draw(parts, this.camera_, this.background_);
    }

    parts_() {
        const { before, after } = this.clouds_;
        const whole = (drawn) => (drawn ? [{ scene: drawn.scene, from: 0, to: 1 }] : []);
        if (this.mode_ === 'before' || !after) return whole(before);
        if (this.mode_ === 'after' || !before) return whole(after);
        return [{ scene: before.scene, from: 0, to: this.split_ },
            { scene: after.scene, from: this.split_, to: 1 }];
    }

    draw_() {
        const ratio = this.renderer_.pixelRatio;
        const focal = this.height_ * ratio / Math.tan(this.camera_.fov * Math.PI / 360);
        for (const drawn of Object.values(this.clouds_)) drawn?.set_size(focal, ratio);
        this.renderer_.draw(this.parts_(), this.camera_, this.background_);
    }

    resize_() {
        const { clientWidth: width, clientHeight: height } = this.canvas_.parentElement;
        if (!width || !height) return;
        this.height_ = height;
        this.renderer_.resize(width, height);
        this.camera_.aspect = width / height;
        this.camera_.updateProjectionMatrix();
        this.redraw();
    }
}
