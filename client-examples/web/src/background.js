const worker = new Worker(new URL('./worker/worker.js', import.meta.url), { type: 'module' });
const waiting = new Map();
let last = 0;

worker.onmessage = ({ data: { id, result, error } }) => {
    const { resolve, reject } = waiting.get(id);
    waiting.delete(id);
    if (error === undefined) resolve(result);
    else reject(new Error(error));
};

/**
 * Has the worker do something (see the methods of worker/worker.js).
 * @param {string} method
 * @param {...*} args what can be cloned
 * @returns {Promise<*>}
 */
export function in_background(method, ...args) {
    const id = ++last;
    return new Promise((resolve, reject) => {
        waiting.set(id, { resolve, reject });
        worker.postMessage({ id, method, args });
    });
}
