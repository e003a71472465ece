import { element } from '../dom.js';
import { job_path } from '../job.js';

const POINTS = [['PLY', 'points?format=ply', 'ply'], ['Draco', 'points?format=drc', 'drc'],
    ['PLY as text', 'points?format=ply-ascii', 'ply']];
const OTHERS = [['Dictionary', 'dictionary', 'json'], ['Fields', 'fields', 'ply'],
    ['Report', 'report', 'json']];

function click_link(href, name) {
    const link = element('a', { href, download: name });
    document.body.append(link);
    link.click();
    link.remove();
}

/** A link cannot send a key: with one, the page fetches the file and hands it on. */
async function save(api, path, name) {
    if (!api.key) return click_link(api.url(path), name);
    const blob = await (await api.request(path)).blob();
    const href = URL.createObjectURL(blob);
    click_link(href, name);
    setTimeout(() => URL.revokeObjectURL(href), 60_000);
}

/**
 * @param {import('../api.js').Api} api
 * @param {string} id of the job
 * @param {object} results what GET /v1/jobs/{id}/results answers
 * @param {string} name of the input, for the names of the files
 * @param {(error: Error) => void} failed
 * @returns {HTMLElement}
 */
export function download_buttons(api, id, results, name, failed) {
    const stem = name.replace(/\.[^.]*$/, '');
    const files = [...(results.points ? POINTS : []), ...OTHERS];
    return element('div.downloads', { role: 'group', 'aria-label': 'Downloads' },
        ...files.map(([label, path, ending], i) => {
            const kind = path.split('?')[0];
            return element(i < 2 && results.points ? 'button.primary' : 'button', { type: 'button',
                'data-download': path,
                onclick: () => save(api, job_path(id, `/results/${path}`), `${stem}-${kind}.${ending}`)
                    .catch(failed) }, label);
        }));
}
