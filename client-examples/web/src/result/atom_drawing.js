const TURN = 0.6;
const TILT = 0.62;
const FARTHEST = 1;     // no displacement is drawn longer than this, in radii
const FULL_COLOR = 0.2;  // height of the deepest colour, in radii
const MOST_POINTS = 900;

/** The squares of a regular grid of points in a plane: four indices each. */
function squares_of(points) {
    const count = points.length / 3;
    let step = Infinity;
    for (let i = 1; i < count; ++i) {
        const gap = Math.abs(points[i * 3] - points[i * 3 - 3]);
        if (gap > 1e-6) step = Math.min(step, gap);
    }
    const stride = Math.max(1, Math.round(Math.sqrt(count / MOST_POINTS)));
    const at = new Map();
    const cell = (i) => [Math.round(points[i * 3] / step), Math.round(points[i * 3 + 1] / step)];
    for (let i = 0; i < count; ++i) at.set(cell(i).join(), i);
    const squares = [];
    for (let i = 0; i < count; ++i) {
        const [x, y] = cell(i);
        if (x % stride || y % stride) continue;
        const corners = [[x, y], [x + stride, y], [x + stride, y + stride], [x, y + stride]]
            .map((place) => at.get(place.join()));
        if (corners.every((corner) => corner !== undefined)) squares.push(corners);
    }
    return squares;
}

/** Height -1..1 to a colour: deep blue, pale, orange. */
function height_color(height, light) {
    const stops = [[38, 92, 168], [222, 226, 233], [226, 110, 38]];
    const at = Math.min(1.999, Math.max(0, height + 1));
    const [from, to] = [stops[Math.floor(at)], stops[Math.floor(at) + 1]];
    const mixed = from.map((value, c) => Math.round((value + (to[c] - value) * (at % 1)) * light));
    return `rgb(${mixed.join()})`;
}

/** How far the point farthest from its place in the pattern is. */
function largest(atom) {
    let most = 0;
    for (let i = 0; i < atom.length; i += 3) {
        most = Math.max(most, Math.hypot(atom[i], atom[i + 1], atom[i + 2]));
    }
    return most || 1;
}

/** Light on a square, from the cross product of its diagonals. */
function light_of([a, b, c, d]) {
    const [ux, uy, uz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const [vx, vy, vz] = [d[0] - b[0], d[1] - b[1], d[2] - b[2]];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const facing = Math.abs(0.35 * n[0] - 0.3 * n[1] + 0.89 * n[2]) / (Math.hypot(...n) || 1);
    return 0.45 + 0.6 * facing;
}

/** Draws atoms of one pattern: the pattern as the atom deforms it, seen from the side. */
export class AtomDrawing {
    /** @param {{patternPoints: Float32Array, pattern: object}} dictionary */
    constructor({ patternPoints, pattern }) {
        this.points_ = patternPoints;
        this.squares_ = pattern?.kind === 'grid' ? squares_of(patternPoints) : [];
    }

    /**
     * @param {HTMLCanvasElement} canvas square
     * @param {Float32Array} atom xyz per pattern point
     * @param {number} strength coefficient at which it is drawn
     */
    draw(canvas, atom, strength) {
        const context = canvas.getContext('2d');
        const size = canvas.width;
        context.clearRect(0, 0, size, size);
        const bent = this.bend_(atom, strength);
        const [cos, sin] = [Math.cos(TURN), Math.sin(TURN)];
        const seen = bent.map(([x, y, z]) => {
            const [across, depth] = [cos * x - sin * y, sin * x + cos * y];
            return [size / 2 + 0.43 * size * across,
                size / 2 - 0.43 * size * (depth * TILT + z * 0.95), depth];
        });
        if (this.squares_.length) this.draw_squares_(context, bent, seen);
        else this.draw_dots_(context, bent, seen);
    }

    bend_(atom, strength) {
        const most = FARTHEST / largest(atom);
        const scale = Math.max(-most, Math.min(most, strength));
        const u = this.points_;
        return Array.from({ length: u.length / 3 }, (_, i) =>
            [0, 1, 2].map((c) => u[i * 3 + c] + scale * atom[i * 3 + c]));
    }

    draw_squares_(context, bent, seen) {
        const depth = (square) => square.reduce((sum, i) => sum + seen[i][2], 0);
        const back_to_front = [...this.squares_].sort((a, b) => depth(b) - depth(a));
        context.lineJoin = 'round';
        context.lineWidth = Math.max(0.5, context.canvas.width / 400);
        for (const square of back_to_front) {
            const corners = square.map((i) => bent[i]);
            const height = corners.reduce((sum, corner) => sum + corner[2], 0) / 4 / FULL_COLOR;
            const light = light_of(corners);
            context.beginPath();
            for (const i of square) context.lineTo(seen[i][0], seen[i][1]);
            context.closePath();
            context.fillStyle = height_color(height, light);
            context.strokeStyle = height_color(height, light * 0.78);
            context.fill();
            context.stroke();
        }
    }

    draw_dots_(context, bent, seen) {
        const radius = context.canvas.width / 80;
        bent.forEach(([, , z], i) => {
            context.beginPath();
            context.arc(seen[i][0], seen[i][1], radius, 0, 2 * Math.PI);
            context.fillStyle = height_color(z / FULL_COLOR, 0.95);
            context.fill();
        });
    }
}
