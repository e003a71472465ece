/** The nearest points so far, in the order of their distance. */
class Best {
    constructor(room) {
        this.indices = new Int32Array(room).fill(-1);
        this.squares = new Float64Array(room).fill(Infinity);
    }

    /** Square of the distance below which a point is of interest. */
    get reach() {
        return this.squares[this.squares.length - 1];
    }

    take(index, square) {
        let at = this.squares.length - 1;
        for (; at > 0 && this.squares[at - 1] > square; --at) {
            this.squares[at] = this.squares[at - 1];
            this.indices[at] = this.indices[at - 1];
        }
        this.squares[at] = square;
        this.indices[at] = index;
    }
}

/**
 * Nearest of many points in 3D. Written here because it has to work on flat typed arrays inside of
 * a worker; the kept libraries want one object a point.
 */
export class KdTree {
    /** @param {Float32Array|Float64Array} points xyz triples */
    constructor(points) {
        this.points = points;
        this.order = Uint32Array.from({ length: points.length / 3 }, (_, i) => i);
        this.axes = new Uint8Array(this.order.length);
        this.build_(0, this.order.length);
    }

    /**
     * @returns {{index: number, distance: number}} index -1 if there are no points
     */
    nearest(x, y, z) {
        const best = new Best(1);
        this.search_([x, y, z], 0, this.order.length, best);
        return { index: best.indices[0], distance: Math.sqrt(best.squares[0]) };
    }

    /** @returns {Int32Array} the k nearest points, nearest first; -1 where there are no more */
    nearest_k(x, y, z, k) {
        const best = new Best(k);
        this.search_([x, y, z], 0, this.order.length, best);
        return best.indices;
    }

    build_(low, high) {
        if (high - low < 2) return;
        const axis = this.widest_(low, high);
        const mid = (low + high) >> 1;
        this.select_(low, high - 1, mid, axis);
        this.axes[mid] = axis;
        this.build_(low, mid);
        this.build_(mid + 1, high);
    }

    widest_(low, high) {
        const { points, order } = this;
        const step = Math.max(1, Math.floor((high - low) / 64));  // a sample will do
        let best = 0;
        let width = -1;
        for (let axis = 0; axis < 3; ++axis) {
            let min = Infinity;
            let max = -Infinity;
            for (let i = low; i < high; i += step) {
                const value = points[order[i] * 3 + axis];
                min = Math.min(min, value);
                max = Math.max(max, value);
            }
            if (max - min > width) [best, width] = [axis, max - min];
        }
        return best;
    }

    /** Hoare's selection: what is smaller along the axis goes before `k`. */
    select_(low, high, k, axis) {
        const { points, order } = this;
        while (low < high) {
            const pivot = points[order[(low + high) >> 1] * 3 + axis];
            let i = low;
            let j = high;
            while (i <= j) {
                while (points[order[i] * 3 + axis] < pivot) ++i;
                while (points[order[j] * 3 + axis] > pivot) --j;
                if (i > j) break;
                [order[i], order[j]] = [order[j], order[i]];
                ++i;
                --j;
            }
            if (k <= j) high = j;
            else if (k >= i) low = i;
            else return;
        }
    }

    search_(query, low, high, best) {
        if (low >= high) return;
        const mid = (low + high) >> 1;
        const at = this.order[mid] * 3;
        const dx = query[0] - this.points[at];
        const dy = query[1] - this.points[at + 1];
        const dz = query[2] - this.points[at + 2];
        const square = dx * dx + dy * dy + dz * dz;
        if (square < best.reach) best.take(this.order[mid], square);
        const axis = this.axes[mid];
        const side = query[axis] - this.points[at + axis];
        const [first, second] = side < 0 ? [[low, mid], [mid + 1, high]] : [[mid + 1, high], [low, mid]];
        this.search_(query, ...first, best);
        if (side * side < best.reach) this.search_(query, ...second, best);
    }
}
