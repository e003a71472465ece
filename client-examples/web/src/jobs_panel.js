import { element } from './dom.js';
import { forget_job, stored_jobs } from './history.js';
import { job_path } from './job.js';

const AGES = [[86400, 'day'], [3600, 'hour'], [60, 'minute']];

function age(created) {
    const seconds = (Date.now() - Date.parse(created)) / 1000;
    const [size, unit] = AGES.find(([least]) => seconds >= least) ?? [1, 'second'];
    return new Intl.RelativeTimeFormat('en', { numeric: 'auto' })
        .format(-Math.floor(seconds / size), unit);
}

/** The state that a server tells of a job; 'gone' if it knows it no more. */
async function state_of(api, id) {
    try {
        const { status, progress } = await api.json(job_path(id));
        return status === 'running' ? `running, ${progress} %` : status;
    } catch (problem) {
        if (problem.code === 'job-dismissed') return 'dismissed';
        return [404, 410].includes(problem.status) ? 'gone' : 'unknown';
    }
}

/** The list of recent jobs. */
export class JobsPanel {
    /** @param {HTMLElement} place @param {(entry: object) => void} open */
    constructor(place, open) {
        this.place_ = place;
        this.open_ = open;
    }

    /** Shows the jobs of a server, and asks it how they are. */
    async show(api) {
        const entries = stored_jobs().filter(({ server }) => server === api.server);
        this.place_.replaceChildren(
            element('h2', {}, 'Recent jobs'),
            entries.length
                ? element('ul.jobs', {}, ...entries.map((entry) => this.row_(api, entry)))
                : element('p.quiet', {}, 'Jobs that you start are listed here, also after a reload.'));
        await Promise.all(entries.map((entry) => this.ask_(api, entry)));
    }

    row_(api, { id, process, file, created }) {
        return element('li', { 'data-job': id },
            element('button.job', { type: 'button', onclick: () => this.open_({ id, file }) },
                element('b', {}, file), element('span', {}, `${process}, ${age(created)}`),
                element('span.state', {}, '…')),
            element('button.remove', { type: 'button', 'aria-label': `Take ${file} off the list`,
                onclick: () => { forget_job(id); this.show(api); } }, '×'));
    }

    async ask_(api, { id }) {
        const state = await state_of(api, id);
        const row = this.place_.querySelector(`[data-job="${CSS.escape(id)}"]`);
        if (!row) return;
        row.querySelector('.state').textContent = state;
        row.dataset.state = state.split(',')[0];
        row.querySelector('.job').disabled = ['gone', 'dismissed'].includes(state);
    }
}
