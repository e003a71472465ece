import { in_background } from '../background.js';
import { element } from '../dom.js';
import { DRAWN_POINTS, is_drawn_whole } from '../input.js';
import { job_path } from '../job.js';
import { download_buttons } from './downloads.js';
import { energy_plot } from './energy_plot.js';
import { report_view } from './report.js';

/** The points of a result: all if they are few, else the server's sample. */
function fetch_points(api, id, points) {
    const path = is_drawn_whole(points)
        ? '/results/points?format=ply' : `/preview?of=result&maxPoints=${DRAWN_POINTS}`;
    return in_background('fetch_cloud', api.location(job_path(id, path)), DRAWN_POINTS);
}

/**
 * Fetches what a job has left behind.
 * @returns {Promise<{results: object, report: object, cloud: object|null, dictionary: object,
 *                    fields: object}>}
 */
export async function fetch_result(api, id) {
    const results = await api.json(job_path(id, '/results'));
    const report = await api.json(job_path(id, '/results/report'));
    const drawn = results.points && { bytes: results.points.bytes, points: report.output.points };
    const [cloud, dictionary, fields] = await Promise.all([
        drawn ? fetch_points(api, id, drawn) : null,
        in_background('fetch_dictionary', api.location(job_path(id, '/results/dictionary'))),
        in_background('fetch_fields', api.location(job_path(id, '/results/fields'))),
    ]);
    return { results, report, cloud, dictionary, fields };
}

/** Shows figures, downloads and the energy of a job. */
export function show_result(place, api, id, name, { results, report }, failed) {
    place.replaceChildren(
        element('h2', {}, 'Download'),
        download_buttons(api, id, results, name, failed),
        element('h2', {}, 'Report'),
        ...report_view(report),
        element('h2', {}, 'Energy'),
        energy_plot(report.energySteps ?? []));
}

/** What stands there before there is a result. */
export function show_no_result(place) {
    place.replaceChildren(element('p.quiet', {},
        'When a job is done, its figures, downloads and energy appear here.'));
}
