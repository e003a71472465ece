import { was_cancelled } from './api.js';
import { in_background } from './background.js';
import { by_id, element } from './dom.js';
import { show_estimate } from './estimate.js';
import { clear_fault, show_fault } from './fault.js';
import { remember_job } from './history.js';
import { fetch_input, is_drawn_whole, send_shape } from './input.js';
import { cancel_job, follow_job, job_path, start_job } from './job.js';
import { count_of, file_size } from './numbers.js';
import { fetch_result, show_no_result, show_result } from './result/result.js';
import { open_tab } from './tabs.js';

/** What the page does: a shape is opened, a job runs on it, its result is shown. */
export class App {
    /** @param {object} parts connection, stage, progress, form, processes, dictionary */
    constructor(parts) {
        Object.assign(this, parts);
        this.session_ = new AbortController();
        this.shape_ = null;
        this.name_ = '';
    }

    get api() {
        return this.connection.api;
    }

    /** Takes a file from the user: shows it and sends it. */
    open_file(file, reference = null) {
        return this.session('setup', async (signal) => {
            this.name_ = file.name;
            this.describe_(`${file_size(file.size)}, on its way`);
            const shape = await send_shape(this.api, file, {
                signal,
                show: (cloud) => !signal.aborted && this.stage.show('before', cloud),
                progress: (share) => this.progress.show('Uploading', 100 * share, file.name,
                    () => this.stop_()),
            });
            await this.stage.set({ reference });
            await this.has_shape_(shape, signal);
        });
    }

    async open_sample(name) {
        const { file, reference } = await in_background('make_sample', name);
        return this.open_file(file, reference);
    }

    /** A shape with known truth: distances to it can be coloured. */
    async open_reference(file) {
        try {
            await this.stage.set({ reference: await in_background('read_cloud', file, 1_000_000) });
            await this.stage.color_by('error');
        } catch (error) {
            show_fault(error);
        }
    }

    /** Starts a job on the shape that is open. */
    run() {
        return this.attempt_(async (signal) => {
            by_id('run').disabled = true;
            try {
                const process = this.processes.id;
                const info = await start_job(this.api, process, this.inputs_(), signal);
                remember_job({ id: info.jobID, server: this.api.server, process, file: this.name_,
                    created: info.created });
                await this.follow_(info.jobID, signal);
            } finally {
                by_id('run').disabled = !this.shape_;
            }
        });
    }

    /** Opens a job of the list: its input, and its result as soon as there is one. */
    open_job({ id, file }) {
        return this.session('result', async (signal) => {
            const info = await this.api.json(job_path(id), { signal });
            this.name_ = file;
            const shape = await this.api.json(`/v1/shapes/${info.shape}`, { signal });
            await this.stage.show('before', await fetch_input(this.api, shape));
            this.processes.choose(info.processID);
            await this.has_shape_(shape, signal);
            await this.follow_(id, signal);
        });
    }

    /** Shows what automatic parameters come to, and what the job would cost. */
    estimate() {
        const inputs = this.shape_ && this.inputs_();
        return show_estimate(this.api, this.processes.id, inputs, this.form, this.session_.signal);
    }

    /** Begins anew: what was going on before is not shown any more. */
    session(tab, work) {
        this.session_.abort();
        this.session_ = new AbortController();
        this.shape_ = null;
        by_id('run').disabled = true;
        this.progress.hide();
        this.stage.clear();
        this.dictionary.clear();
        show_no_result(by_id('panel-result'));
        open_tab(tab);
        return this.attempt_(work);
    }

    async attempt_(work) {
        const { signal } = this.session_;
        clear_fault();
        this.form.clear_faults();
        try {
            await work(signal);
        } catch (error) {
            if (was_cancelled(error) || signal.aborted) return;
            this.fail_(error);
        } finally {
            if (signal === this.session_.signal) this.progress.hide();
        }
    }

    fail_(error) {
        if (error.status === 401) this.connection.ask(error.detail);
        if (this.form.show_faults(error.errors ?? [])) open_tab('setup');
        show_fault(error);
    }

    inputs_() {
        return { shape: this.shape_.id, ...this.form.values() };
    }

    async has_shape_(shape, signal) {
        if (signal.aborted) return;
        this.shape_ = shape;
        by_id('run').disabled = false;
        const faces = shape.faces ? `, ${count_of(shape.faces, 'triangle')}` : '';
        const drawn = this.stage.scene.before;
        const part = drawn && drawn.count < shape.points ? `, ${count_of(drawn.count, 'point')} drawn` : '';
        this.describe_(`${count_of(shape.points, 'point')}${faces}, ${file_size(shape.bytes)}${part}`);
        this.progress.say(`${this.name_} is ready.`);
        this.progress.hide();
        await this.estimate();
    }

    describe_(text) {
        by_id('shape').replaceChildren(element('p.shape-name', {}, this.name_),
            element('p.quiet', {}, text));
    }

    async follow_(id, signal) {
        const cancel = () => cancel_job(this.api, id).catch((error) => this.fail_(error));
        const info = await follow_job(this.api, id, (now) => {
            this.progress.show_job(now, cancel);
            this.form.show_resolved(now.resolvedParameters);
        }, signal).catch((error) => {
            if (error.code === 'job-dismissed') return { status: 'dismissed' };
            throw error;
        });
        this.progress.hide();
        if (info.status === 'dismissed') this.progress.say('The job was cancelled.');
        else await this.show_result_(id, signal);
    }

    async show_result_(id, signal) {
        const result = await fetch_result(this.api, id);
        if (signal.aborted) return;
        const { cloud, report, fields, dictionary } = result;
        if (cloud) await this.show_points_(cloud, report);
        await this.stage.set({ fields });
        show_result(by_id('panel-result'), this.api, id, this.name_, result, (e) => this.fail_(e));
        open_tab('result');
        this.progress.say('The result is there.');
        if (!cloud) await this.stage.color_by('dimension');
        await this.dictionary.show(dictionary, fields);
    }

    async show_points_(cloud, report) {
        // Samples of ours and of the server take other points: compare those of the server.
        if (!is_drawn_whole(this.shape_)) {
            await this.stage.show('before', await fetch_input(this.api, this.shape_));
        }
        const { before } = this.stage.scene;
        const inOrder = report.processID === 'denoise' && before.count === cloud.count &&
            before.total === cloud.total;
        await this.stage.set({ inOrder });
        await this.stage.show('after', cloud);
        this.stage.look('compare');
    }

    /** Stops an upload. */
    stop_() {
        this.session_.abort();
        this.progress.hide();
        this.describe_('not sent');
    }
}
