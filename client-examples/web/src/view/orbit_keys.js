import { Spherical, Vector3 } from 'three';

const TURN = Math.PI / 24;
const ZOOM = 1.12;

/** What each key does to the place of the camera around its target. */
const KEYS = {
    ArrowLeft: (at) => { at.theta -= TURN; },
    ArrowRight: (at) => { at.theta += TURN; },
    ArrowUp: (at) => { at.phi -= TURN; },
    ArrowDown: (at) => { at.phi += TURN; },
    '+': (at) => { at.radius /= ZOOM; },
    '=': (at) => { at.radius /= ZOOM; },
    '-': (at) => { at.radius *= ZOOM; },
};

/** Turns and zooms the view by keys; "0" and Home fit the shape in. */
export function orbit_by_keys(canvas, camera, controls, fit) {
    const offset = new Vector3();
    canvas.addEventListener('keydown', (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (event.key === '0' || event.key === 'Home') {
            fit();
        } else if (KEYS[event.key]) {
            // Spherical measures from the y axis; here z is up.
            offset.subVectors(camera.position, controls.target);
            const at = new Spherical().setFromCartesianCoords(offset.y, offset.z, offset.x);
            KEYS[event.key](at);
            at.makeSafe();
            const turned = new Vector3().setFromSpherical(at);
            camera.position.copy(controls.target).add(offset.set(turned.z, turned.x, turned.y));
            controls.update();
        } else {
            return;
        }
        event.preventDefault();
    });
}
