import { is_missing_path, was_cancelled } from './api.js';
import { by_id } from './dom.js';
import { duration, file_size } from './numbers.js';

/** What a job would do and take; null where the server does not tell, or nobody asks any more. */
async function validate(api, process, inputs, signal) {
    try {
        return await api.post(`/v1/processes/${process}/validate`, { inputs }, { signal });
    } catch (error) {
        if (was_cancelled(error) || is_missing_path(error)) return null;
        throw error;
    }
}

let latest = 0;  // of several answers on their way, only the last question's counts

/**
 * Shows what automatic parameters come to, what the job would cost, and what to beware of.
 * @param {import('./api.js').Api} api
 * @param {string} process
 * @param {object|null} inputs null: there is no shape yet
 * @param {import('./parameters.js').ParameterForm} form
 * @param {AbortSignal} signal
 */
export async function show_estimate(api, process, inputs, form, signal) {
    by_id('estimate').textContent = '';
    form.show_resolved({});
    const mine = ++latest;
    if (!inputs) return;
    try {
        const answer = await validate(api, process, inputs, signal);
        if (!answer || signal.aborted || mine !== latest) return;
        form.show_resolved(answer.resolvedParameters);
        const { seconds, memoryBytes } = answer.estimate;
        const cost = `About ${duration(seconds)} and ${file_size(memoryBytes)} of memory.`;
        by_id('estimate').textContent =
            [cost, ...answer.warnings.map(({ detail }) => detail)].join(' ');
    } catch (error) {
        if (mine === latest) form.show_faults(error.errors ?? [], { focus: false });
    }
}
