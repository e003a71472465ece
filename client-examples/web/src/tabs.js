import { by_id } from './dom.js';

const tabs = () => [...document.querySelectorAll('[role=tab]')];

/** @param {string} name setup, result, dictionary or jobs */
export function open_tab(name) {
    for (const tab of tabs()) {
        const chosen = tab.id === `tab-${name}`;
        tab.setAttribute('aria-selected', String(chosen));
        tab.tabIndex = chosen ? 0 : -1;
        by_id(tab.getAttribute('aria-controls')).hidden = !chosen;
    }
    by_id('side').scrollTop = 0;
}

/** Lets clicks and arrow keys choose tabs. @param {(name: string) => void} opened */
export function start_tabs(opened) {
    const choose = (tab) => {
        open_tab(tab.id.slice('tab-'.length));
        opened(tab.id.slice('tab-'.length));
    };
    tabs().forEach((tab, i, all) => {
        tab.addEventListener('click', () => choose(tab));
        tab.addEventListener('keydown', ({ key }) => {
            const step = { ArrowRight: 1, ArrowLeft: -1 }[key];
            if (!step) return;
            const next = all[(i + step + all.length) % all.length];
            choose(next);
            next.focus();
        });
    });
    open_tab('setup');
}
