import { by_id } from './dom.js';
import { duration } from './numbers.js';

const ANNOUNCE_STEP = 25;  // percent between two announcements to a screen reader

const VERBS = { denoise: 'Denoising', resample: 'Resampling', analyze: 'Analysing' };

/** What a job is doing, in one line. */
function detail_of(info) {
    if (info.status === 'accepted') {
        return info.queuePosition ? `waiting, number ${info.queuePosition} in the queue` : 'waiting';
    }
    const { phase = '', phaseProgress: part, etaSeconds } = info;
    const share = part?.total ? ` ${part.done} of ${part.total} ${part.unit}` : '';
    const rest = etaSeconds > 1 ? `, about ${duration(etaSeconds)} left` : '';
    return `${phase}${share}${rest}`;
}

/** The strip at the foot of the view: what is going on, how far it is, and how to stop it. */
export class ProgressStrip {
    constructor() {
        this.cancel_ = null;
        by_id('cancel').addEventListener('click', () => this.cancel_?.());
    }

    /**
     * @param {string} title
     * @param {number} percent
     * @param {string} detail
     * @param {() => void} cancel
     */
    show(title, percent, detail, cancel) {
        this.cancel_ = cancel;
        by_id('progress').hidden = false;
        by_id('progress-title').textContent = title;
        by_id('progress-detail').textContent = `${Math.round(percent)} %${detail ? ` · ${detail}` : ''}`;
        by_id('progress-bar').value = percent;
        const step = Math.floor(percent / ANNOUNCE_STEP);
        if (title !== this.title_ || step !== this.step_) this.say(`${title}: ${Math.round(percent)} %`);
        [this.title_, this.step_] = [title, step];
    }

    /** @param {object} info statusInfo */
    show_job(info, cancel) {
        this.show(VERBS[info.processID] ?? info.processID, info.progress ?? 0, detail_of(info), cancel);
    }

    hide() {
        const had_focus = document.activeElement === by_id('cancel');
        by_id('progress').hidden = true;
        this.title_ = undefined;
        if (had_focus) by_id('side').focus();
    }

    /** Tells a screen reader, and nobody else. */
    say(text) {
        by_id('announcer').textContent = text;
    }
}
