import { by_id } from './dom.js';

const NAME = 'lpf-theme';
const bright = matchMedia('(prefers-color-scheme: light)');

/** The colour of the view's background, as the style sheet has it. */
function background() {
    const value = getComputedStyle(document.documentElement).getPropertyValue('--view').trim();
    return [1, 3, 5].map((at) => parseInt(value.slice(at, at + 2), 16));
}

/**
 * Follows the system's choice of dark or light until the user makes one.
 * @param {(theme: 'dark'|'light', background: number[]) => void} changed
 */
export function start_theme(changed) {
    const root = document.documentElement;
    const apply = () => {
        const theme = localStorage.getItem(NAME) ?? (bright.matches ? 'light' : 'dark');
        root.dataset.theme = theme;
        by_id('theme').textContent = theme === 'dark' ? 'Light' : 'Dark';
        changed(theme, background());
    };
    bright.addEventListener('change', apply);
    by_id('theme').addEventListener('click', () => {
        localStorage.setItem(NAME, root.dataset.theme === 'dark' ? 'light' : 'dark');
        apply();
    });
    apply();
}
