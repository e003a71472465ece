import { element } from '../dom.js';
import { duration, file_size, short_number } from '../numbers.js';

/** Pairs of what is told first of a report; what it does not have is left out. */
function figures(report) {
    const { input, output, measurements: m, displacement: d } = report;
    const radius = report.resolvedParameters?.radius?.value;
    return [
        ['Points', output ? `${short_number(input.points)} → ${short_number(output.points)}`
            : short_number(input.points)],
        input.faces > 0 && ['Triangles', short_number(input.faces)],
        m && ['Noise measured', short_number(m.noise)],
        m && ['Mean spacing', short_number(m.meanSpacing)],
        radius && ['Radius of the fields', short_number(radius)],
        ['Fields', short_number(report.fields)],
        d && ['Displacement, RMS', short_number(d.rms)],
        d && ['Displacement, largest', short_number(d.max)],
        report.outliers > 0 && ['Outliers', short_number(report.outliers)],
        report.duplicates > 0 && ['Duplicates', short_number(report.duplicates)],
        report.nonFinite > 0 && ['Not finite, dropped', short_number(report.nonFinite)],
        ['Time', duration(report.seconds)],
        ['Threads', short_number(report.threads)],
        report.peakMemoryBytes && ['Memory, at most', file_size(report.peakMemoryBytes)],
    ].filter(Boolean);
}

function parameter_table(resolved) {
    const value = (v) => (typeof v === 'number' ? short_number(v) : v);
    return element('details', {},
        element('summary', {}, 'Parameters that were used'),
        element('table', {},
            element('thead', {}, element('tr', {}, ...['Parameter', 'Value', 'Why'].map((name) =>
                element('th', { scope: 'col' }, name)))),
            element('tbody', {}, ...Object.entries(resolved).map(([name, one]) => element('tr', {},
                element('th', { scope: 'row' }, name), element('td', {}, value(one.value)),
                element('td', {}, one.source === 'auto' ? one.rule : 'as given'))))));
}

/** What is worth knowing, as a list; nothing if there is nothing. */
export function warning_list(warnings) {
    if (!warnings?.length) return null;
    return element('ul.warnings', {}, ...warnings.map(({ detail }) => element('li', {}, detail)));
}

/** @param {object} report of a job @returns {Node[]} its figures, warnings and parameters */
export function report_view(report) {
    return [
        element('dl.figures', {}, ...figures(report).map(([name, value]) =>
            element('div', {}, element('dt', {}, name), element('dd', {}, value)))),
        warning_list(report.warnings),
        parameter_table(report.resolvedParameters ?? {}),
    ].filter(Boolean);
}
