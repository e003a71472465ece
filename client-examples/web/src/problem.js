/**
 * Why something went wrong, in words for the user: what a problem document (RFC 9457) says, or
 * what the page knows when no answer came at all.
 */
export class Problem extends Error {
    /** @param {{title: string, detail?: string, status?: number, code?: string,
     *           errors?: {pointer: string, detail: string}[]}} document */
    constructor({ title, detail = '', status = 0, code = '', errors = [] }) {
        super(detail || title);
        Object.assign(this, { title, detail, status, code, errors });
    }
}

/** @param {{status: number, text: string}} answer @returns {Problem} */
export function problem_from_answer({ status, text }) {
    try {
        const document = JSON.parse(text);
        if (document.title) return new Problem({ ...document, status });
    } catch {
        // Not JSON: a proxy in between has answered.
    }
    return new Problem({ status, title: `The server answered with status ${status}`,
        detail: 'It gave no reason. Perhaps something between this page and the server answered.' });
}

/** @param {string} server its origin @returns {Problem} */
export function unreachable(server) {
    const foreign = server !== location.origin;
    return new Problem({
        title: 'The server does not answer',
        code: 'unreachable',
        detail: foreign
            ? `${server} cannot be reached, or it does not allow pages from ${location.origin}. ` +
              `Its operator can allow them: --cors-origin ${location.origin}`
            : `${server} cannot be reached. Is it running, and is there a network?`,
    });
}
