import { by_id, element } from './dom.js';
import { Problem } from './problem.js';

/** What the user can read of any error. */
function as_problem(error) {
    if (error instanceof Problem) return error;
    return new Problem({ title: 'That did not work', detail: error.message });
}

/**
 * Says what went wrong, above the controls.
 * @param {Error} error
 * @param {{errors: boolean}} [show] whether to list the single errors (else they stand elsewhere)
 */
export function show_fault(error, show = { errors: true }) {
    const { title, detail, code, errors } = as_problem(error);
    const more = show.errors ? errors.filter((one) => one.detail !== detail) : [];
    by_id('fault').replaceChildren(
        element('h2', {}, title),
        detail && element('p', {}, detail),
        more.length > 0 && element('ul', {}, ...more.map((one) =>
            element('li', {}, element('code', {}, one.pointer), ` ${one.detail}`))),
        code && code !== 'unreachable' && element('p.quiet', {}, `Code: ${code}`),
        element('button', { type: 'button', 'aria-label': 'Close this message', onclick: clear_fault }, '×'));
}

export function clear_fault() {
    by_id('fault').replaceChildren();
}
