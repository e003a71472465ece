import { element } from '../dom.js';
import { short_number } from '../numbers.js';
import { MAPS } from './color_maps.js';

function swatch(color) {
    const made = element('span.swatch', { 'aria-hidden': 'true' });
    made.style.background = color;
    return made;
}

function rms_line(rms) {
    const parts = Object.entries(rms).map(([side, value]) => `${short_number(value)} ${side}`);
    return element('span.rms', {}, `RMS ${parts.join(', ')}`);
}

/**
 * Explains the colours.
 * @param {HTMLElement} place
 * @param {string} label
 * @param {{range?: number[], map?: string, classes?: {name: string, color: string}[],
 *     rms?: Object<string, number>}} legend rms: root mean square of each side
 */
export function show_legend(place, label, { range, map, classes, rms }) {
    place.hidden = !range && !classes;
    if (classes) {
        place.replaceChildren(element('b', {}, label), ...classes.map(({ name, color }) =>
            element('span.class', {}, swatch(color), name)));
    } else if (range) {
        const bar = element('span.ramp', { 'aria-hidden': 'true' });
        bar.style.background = `linear-gradient(to right, ${MAPS[map].join(', ')})`;
        place.replaceChildren(...[element('b', {}, label), element('span.scale', {},
            element('span', {}, short_number(range[0])), bar,
            element('span', {}, short_number(range[1]))), rms && rms_line(rms)].filter(Boolean));
    }
}
