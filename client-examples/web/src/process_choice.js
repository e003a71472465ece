import { element } from './dom.js';

/** The choice of what to do, and what the server tells of each process. */
export class ProcessChoice {
    /** @param {HTMLElement} place a radio group @param {(process: object) => void} chosen */
    constructor(place, chosen) {
        this.place_ = place;
        this.chosen_ = chosen;
        this.processes_ = new Map();
    }

    /** Asks a server what it can do; the process that was chosen stays chosen. */
    async load(api) {
        const { processes } = await api.json('/v1/processes');
        const full = await Promise.all(processes.map(({ id }) => api.json(`/v1/processes/${id}`)));
        this.processes_ = new Map(full.map((process) => [process.id, process]));
        const first = this.processes_.has(this.id) ? this.id : full[0].id;
        this.place_.replaceChildren(...full.map((process) => this.option_(process, process.id === first)));
        this.choose(first);
    }

    /** @returns {string} */
    get id() {
        return this.current_?.id;
    }

    choose(id) {
        this.current_ = this.processes_.get(id);
        for (const input of this.place_.querySelectorAll('input')) input.checked = input.value === id;
        this.chosen_(this.current_);
    }

    option_({ id, title, description }, checked) {
        return element('label.process', {},
            element('input', { type: 'radio', name: 'process', value: id, checked,
                onchange: () => this.choose(id) }),
            element('span', {}, element('b', {}, title ?? id), element('small', {}, description)));
    }
}
