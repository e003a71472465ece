const whole = new Intl.NumberFormat('en');

/** Three significant digits, and no more zeros than needed: 0.0215, 13.4, 1.2e-7. */
export function short_number(value) {
    if (!Number.isFinite(value)) return '–';
    if (Number.isInteger(value) && Math.abs(value) < 1e15) return whole.format(value);
    const size = Math.abs(value);
    if (size < 1e-4 || size >= 1e9) return value.toExponential(2);
    if (size >= 1000) return whole.format(Math.round(value));
    return String(Number(value.toPrecision(3)));
}

/** 1.4 s, 3 min 05 s */
export function duration(seconds) {
    if (seconds < 10) return `${seconds.toFixed(1)} s`;
    if (seconds < 60) return `${Math.round(seconds)} s`;
    const rest = String(Math.round(seconds) % 60).padStart(2, '0');
    return `${Math.floor(Math.round(seconds) / 60)} min ${rest} s`;
}

/** 240 KB, 12.3 MB */
export function file_size(bytes) {
    const units = ['B', 'KB', 'MB', 'GB'];
    const power = Math.min(3, Math.floor(Math.log10(Math.max(1, bytes)) / 3));
    return `${short_number(bytes / 1000 ** power)} ${units[power]}`;
}

/** "1 point", "2,000 points" */
export function count_of(number, unit) {
    return `${whole.format(number)} ${unit}${number === 1 ? '' : 's'}`;
}

/** The value that a share of all do not exceed, by a sample of at most 20 000. */
export function quantile(values, share) {
    const step = Math.max(1, Math.floor(values.length / 20_000));
    const sample = [];
    for (let i = 0; i < values.length; i += step) {
        if (Number.isFinite(values[i])) sample.push(values[i]);
    }
    sample.sort((a, b) => a - b);
    return sample[Math.min(sample.length - 1, Math.floor(share * sample.length))] ?? 0;
}
