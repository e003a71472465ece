import { element, svg_element } from '../dom.js';
import { short_number } from '../numbers.js';

const [WIDTH, HEIGHT] = [340, 170];
const [LEFT, RIGHT, TOP, BOTTOM] = [46, 10, 12, 30];
const STEPS = [['learning', 'after learning the dictionary'], ['pose', 'after fitting the poses'],
    ['probing', 'after probing anew']];

/** The energy after each step of each iteration, in the order in which they were made. */
function values_in_order(energySteps) {
    return energySteps.flatMap((steps, iteration) => STEPS.filter(([name]) => name in steps)
        .map(([name]) => ({ iteration, name, value: steps[name] })));
}

function text(x, y, anchor, content) {
    return svg_element('text', { x, y, 'text-anchor': anchor }, content);
}

function axes(low, high, y, iterations, x_of_iteration) {
    const parts = [];
    const digits = Math.max(0, 1 - Math.floor(Math.log10(high - low)));
    for (let i = 0; i <= 3; ++i) {
        const value = low + (high - low) * i / 3;
        parts.push(svg_element('line', { class: 'grid', x1: LEFT, x2: WIDTH - RIGHT, y1: y(value),
            y2: y(value) }),
            text(LEFT - 6, y(value) + 3.5, 'end', value.toFixed(digits)));
    }
    const every = Math.ceil(iterations / 10);
    for (let i = 0; i < iterations; i += every) {
        parts.push(text(x_of_iteration(i), HEIGHT - 14, 'middle', String(i + 1)));
    }
    parts.push(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 1, 'middle', 'iteration'));
    return parts;
}

function draw(points, iterations) {
    const all = points.map(({ value }) => value);
    const spread = Math.max(...all) - Math.min(...all) || Math.max(...all) * 0.1 || 1;
    const low = Math.max(0, Math.min(...all) - 0.1 * spread);
    const high = Math.max(...all) + 0.1 * spread;
    const x = (i) => LEFT + (WIDTH - LEFT - RIGHT) * (i + 0.5) / points.length;
    const y = (value) => TOP + (HEIGHT - TOP - BOTTOM) * (high - value) / (high - low);
    const steps = points.length / iterations;
    const line = points.map(({ value }, i) => `${i ? 'L' : 'M'}${x(i).toFixed(1)} ${y(value).toFixed(1)}`);
    return svg_element('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'plot', role: 'img',
        'aria-label': `Energy per field goes from ${short_number(all[0])} to ` +
            `${short_number(all.at(-1))} in ${iterations} iterations` },
    ...axes(low, high, y, iterations, (i) => x(i * steps + (steps - 1) / 2)),
    svg_element('path', { class: 'line', d: line.join('') }),
    ...points.map(({ name, value }, i) =>
        svg_element('circle', { class: `dot ${name}`, cx: x(i), cy: y(value), r: 3.2 })));
}

/**
 * @param {{learning: number, pose: number, probing: number}[]} energySteps one entry an iteration
 * @returns {HTMLElement} a figure with the plot and its key
 */
export function energy_plot(energySteps) {
    const points = values_in_order(energySteps);
    if (!points.length) return element('p.quiet', {}, 'No energy was recorded.');
    return element('figure.energy', {},
        draw(points, energySteps.length),
        element('figcaption', {}, 'Energy per field, ', ...STEPS.map(([name, label]) =>
            element('span.key', {}, element(`span.dot.${name}`, { 'aria-hidden': 'true' }), label))));
}
