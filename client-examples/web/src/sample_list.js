import { element } from './dom.js';
import { SAMPLES, paint_color, random_numbers } from './worker/samples.js';

const NAMES = { cube: 'Cube with a wire', sphere: 'Sphere with a border', sinusoid: 'Sinusoid',
    knot: 'Knot' };
const DOTS = 1800;

/** A first impression of a sample. */
function draw(canvas, { make, noise }) {
    const context = canvas.getContext('2d');
    const random = random_numbers(7);
    const dots = Array.from({ length: DOTS }, () => {
        const { place: [x, y, z], paint } = make(random);
        const shake = () => noise * 2 * (random() - 0.5);
        return { across: 0.83 * x - 0.55 * y + shake(), depth: 0.55 * x + 0.83 * y,
            up: z + shake(), paint };
    }).sort((a, b) => b.depth - a.depth);
    const reach = Math.max(...dots.map(({ across, depth, up }) =>
        Math.max(Math.abs(across), Math.abs(0.86 * up + 0.42 * depth))));
    const scale = 0.43 * canvas.width / reach;
    for (const { across, depth, up, paint } of dots) {
        const [r, g, b] = paint_color(paint).map((v) => Math.round(v * (1 - 0.16 * (depth + 1))));
        context.fillStyle = `rgb(${r}, ${g}, ${b})`;
        context.fillRect(canvas.width / 2 + scale * across,
            canvas.height / 2 - scale * (0.86 * up + 0.42 * depth), 2, 2);
    }
}

/**
 * Offers the simulated scans.
 * @param {HTMLElement} place a list
 * @param {(name: string) => void} chosen
 */
export function show_samples(place, chosen) {
    for (const [name, sample] of Object.entries(SAMPLES)) {
        const canvas = element('canvas', { width: 160, height: 160, 'aria-hidden': 'true' });
        draw(canvas, sample);
        place.append(element('li', {}, element('button.sample', { type: 'button', 'data-sample': name,
            onclick: () => chosen(name) }, canvas, element('span', {}, NAMES[name]))));
    }
}
