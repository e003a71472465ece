import { element } from '../dom.js';
import { AtomDrawing } from './atom_drawing.js';
import { atom_strengths } from './atom_strength.js';

const FRAME_MILLISECONDS = 12;
const next_frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
const percent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;

/** The dictionary as small pictures, most used first. One can be chosen. */
export class DictionaryView {
    /** @param {HTMLElement} place @param {(atom: number|null) => void} chosen */
    constructor(place, chosen) {
        this.place_ = place;
        this.chosen_ = chosen;
        this.buttons_ = new Map();
    }

    clear() {
        this.place_.replaceChildren(element('p.quiet', {},
            'The local shapes that a job has learned appear here.'));
        this.shown_ = null;
    }

    /**
     * @param {object} dictionary patternPoints, atoms, usage, pattern, radius
     * @param {import('../worker/fields.js').Fields} fields of the shape that it was learned on
     */
    async show(dictionary, fields) {
        this.shown_ = dictionary;
        const order = dictionary.atoms.map((_, k) => k)
            .sort((a, b) => dictionary.usage[b] - dictionary.usage[a]);
        this.buttons_ = new Map(order.map((k) => [k, this.button_(k, dictionary.usage[k])]));
        this.place_.replaceChildren(this.introduction_(dictionary),
            element('ul.atoms', {}, ...order.map((k) => element('li', {}, this.buttons_.get(k)))));
        await this.draw_(dictionary, order, atom_strengths(fields, order.length));
    }

    /** Marks one atom as chosen, or none. */
    mark(atom) {
        for (const [k, button] of this.buttons_) {
            button.setAttribute('aria-pressed', k === atom ? 'true' : 'false');
        }
    }

    introduction_({ atoms, patternPoints }) {
        return element('p.quiet', {},
            `${atoms.length} atoms over a pattern of ${patternPoints.length / 3} points, most used ` +
            'first. Each is drawn as it deforms the pattern, as strongly as this shape uses it, orange ' +
            'above and blue below the plane. Choose one to light up where the shape uses it.');
    }

    button_(k, usage) {
        const unseen = (text) => element('span.hidden', {}, text);
        return element('button.atom', { type: 'button', 'aria-pressed': 'false',
            onclick: (event) => {
                const pressed = event.currentTarget.getAttribute('aria-pressed') === 'true';
                this.mark(pressed ? null : k);
                this.chosen_(pressed ? null : k);
            } },
        element('canvas', { width: 176, height: 176, 'aria-hidden': 'true' }),
        element('span.atom-name', {},
            element('span', {}, unseen('Atom '), element('b', {}, String(k + 1))),
            element('span', {}, unseen('used by '), percent(usage), unseen(' of the fields'))));
    }

    /** A few at a time, so that hundreds of atoms do not hold up the page. */
    async draw_(dictionary, order, strengths) {
        const drawing = new AtomDrawing(dictionary);
        let since = performance.now();
        for (const k of order) {
            if (this.shown_ !== dictionary) return;
            drawing.draw(this.buttons_.get(k).firstElementChild, dictionary.atoms[k],
                strengths[k]);
            if (performance.now() - since < FRAME_MILLISECONDS) continue;
            await next_frame();
            since = performance.now();
        }
    }
}
