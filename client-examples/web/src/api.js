import { Problem, problem_from_answer, unreachable } from './problem.js';

/** The HTTP interface of one server, with the key that it may ask for. */
export class Api {
    /** @param {{server: string, key: string}} connection */
    constructor({ server, key }) {
        this.server = server.replace(/\/+$/, '');
        this.key = key;
    }

    url(path) {
        return new URL(path, `${this.server}/`).href;
    }

    headers(more = {}) {
        return this.key ? { Authorization: `Bearer ${this.key}`, ...more } : more;
    }

    /** What the worker needs to fetch a path by itself. */
    location(path) {
        return { url: this.url(path), headers: this.headers() };
    }

    /**
     * @returns {Promise<Response>} of a success
     * @throws {Problem} otherwise
     */
    async request(path, { method = 'GET', headers = {}, body, signal } = {}) {
        let response;
        try {
            response = await fetch(this.url(path), {
                method, body, signal, headers: this.headers(headers), cache: 'no-store' });
        } catch (error) {
            throw error.name === 'AbortError' ? error : unreachable(this.server);
        }
        if (response.ok) return response;
        throw problem_from_answer({ status: response.status, text: await response.text() });
    }

    /** @returns {Promise<object>} the JSON of a success */
    async json(path, options) {
        return (await this.request(path, options)).json();
    }

    post(path, value, { headers = {}, signal } = {}) {
        return this.json(path, { method: 'POST', body: JSON.stringify(value), signal,
            headers: { 'Content-Type': 'application/json', ...headers } });
    }

    /**
     * Sends a file as it is. XMLHttpRequest, because fetch tells no progress of an upload.
     * @param {string} path
     * @param {Blob} file
     * @param {{progress: (share: number) => void, signal: AbortSignal}} options
     * @returns {Promise<object>} the JSON of the answer
     */
    upload(path, file, { progress, signal }) {
        return new Promise((resolve, reject) => {
            const request = new XMLHttpRequest();
            request.open('POST', this.url(path));
            const headers = this.headers({ 'Content-Type': 'application/octet-stream' });
            for (const [name, value] of Object.entries(headers)) request.setRequestHeader(name, value);
            request.upload.onprogress = (event) => progress(event.loaded / event.total);
            request.onload = () => (request.status < 300
                ? resolve(JSON.parse(request.responseText))
                : reject(problem_from_answer({ status: request.status, text: request.responseText })));
            request.onerror = () => reject(unreachable(this.server));
            request.onabort = () => reject(new DOMException('Cancelled.', 'AbortError'));
            signal.addEventListener('abort', () => request.abort());
            request.send(file);
        });
    }
}

/** @returns {boolean} whether an error only says that the user took something back */
export function was_cancelled(error) {
    return error.name === 'AbortError';
}

/** @returns {boolean} whether a server does not know a path at all (an older one) */
export function is_missing_path(error) {
    return error instanceof Problem && [404, 405, 501].includes(error.status) &&
        !/^(job|shape|dictionary|process)-/.test(error.code);
}
