import { by_id, element } from '../dom.js';
import { color, color_modes } from './coloring.js';
import { make_divider } from './divider.js';
import { show_legend } from './legend.js';
import { Viewer } from './viewer.js';

/** The view with its controls: which side, divider, colours, legend. */
export class Stage {
    constructor() {
        this.viewer_ = new Viewer(by_id('canvas'));
        this.select_ = by_id('color');
        this.select_.addEventListener('change', () => this.choose_(this.select_.value));
        this.views_ = document.querySelectorAll('input[name=view]');
        for (const view of this.views_) view.addEventListener('change', () => this.look(view.value));
        make_divider(by_id('divider'), (share) => { this.viewer_.split = share; });
        by_id('fit').addEventListener('click', () => this.viewer_.fit());
        this.clear();
    }

    /** Takes everything away. */
    clear() {
        this.scene = { before: null, after: null, fields: null, reference: null, atom: null,
            inOrder: false, cache: new Map(), theme: this.scene?.theme ?? 'dark' };
        this.mode_ = 'plain';
        this.viewer_.show('before', null);
        this.viewer_.show('after', null);
        this.look('before');
        this.update_();
    }

    /** @param {'dark'|'light'} theme @param {number[]} background */
    set_theme(theme, background) {
        this.scene.theme = theme;
        this.viewer_.background = background;
        this.update_();
    }

    /** @param {'before'|'after'} side @param {import('../worker/cloud.js').Cloud} cloud */
    show(side, cloud) {
        const first = !this.scene.before && !this.scene.after;
        this.scene[side] = cloud;
        this.scene.cache.clear();
        this.viewer_.show(side, cloud);
        if (first) this.viewer_.fit();
        return this.update_();
    }

    /** Sets members of the scene that colours are made of. */
    set(members) {
        Object.assign(this.scene, members);
        this.scene.cache.clear();
        return this.update_();
    }

    /** @param {'before'|'compare'|'after'} mode */
    look(mode) {
        this.viewer_.mode = mode;
        for (const view of this.views_) view.checked = view.value === mode;
        by_id('stage').dataset.view = mode;
        by_id('divider').hidden = mode !== 'compare';
    }

    /** @param {string} mode id of a way to colour */
    color_by(mode) {
        this.mode_ = mode;
        return this.update_();
    }

    /** Lights up where an atom is used; null: no more. */
    light_atom(atom) {
        this.scene.atom = atom;
        return this.color_by(atom === null ? 'plain' : 'atom');
    }

    choose_(mode) {
        this.color_by(mode);
        this.on_choice?.(mode);
    }

    async update_() {
        const { scene } = this;
        const modes = color_modes(scene);
        if (!modes.some(({ id }) => id === this.mode_)) this.mode_ = 'plain';
        const mode = this.mode_;
        this.select_.replaceChildren(...modes.map(({ id, label }) =>
            element('option', { value: id, selected: id === mode }, label)));
        by_id('stage').classList.toggle('has-shape', Boolean(scene.before || scene.after));
        for (const view of this.views_) {
            view.disabled = !(scene.before && scene.after) && view.value !== 'before';
        }
        const { tints, legend } = await color(scene, mode);
        if (scene !== this.scene || mode !== this.mode_) return;  // something newer is on its way
        const ambient = mode === 'plain' ? 0.4 : 0.68;  // colours that mean something stay legible
        for (const [side, list] of Object.entries(tints)) {
            if (this.viewer_.cloud(side)?.count * 3 === list.length) {
                this.viewer_.paint(side, list, ambient);
            }
        }
        show_legend(by_id('legend'), modes.find(({ id }) => id === mode).label, legend);
    }
}
