import { App } from './app.js';
import { Connection } from './connection.js';
import { by_id } from './dom.js';
import { accept_files } from './drop.js';
import { show_fault } from './fault.js';
import { JobsPanel } from './jobs_panel.js';
import { ParameterForm } from './parameters.js';
import { ProcessChoice } from './process_choice.js';
import { ProgressStrip } from './progress.js';
import { DictionaryView } from './result/dictionary.js';
import { show_no_result } from './result/result.js';
import { show_samples } from './sample_list.js';
import { start_tabs } from './tabs.js';
import { start_theme } from './theme.js';
import { Stage } from './view/stage.js';

function make_stage() {
    try {
        return new Stage();
    } catch {
        show_fault(new Error('This browser cannot draw in 3D (WebGL 2), which the page needs. ' +
            'The service itself works without a page: see /v1/openapi.json.'));
        throw new Error('no WebGL');
    }
}

const stage = make_stage();
const form = new ParameterForm(by_id('inputs'), () => app.estimate());
const dictionary = new DictionaryView(by_id('panel-dictionary'), (atom) => stage.light_atom(atom));
const processes = new ProcessChoice(by_id('processes'), (process) => {
    form.show(process);
    app.estimate();
});
const jobs = new JobsPanel(by_id('panel-jobs'), (entry) => app.open_job(entry));
const connection = new Connection(load);
const app = new App({ connection, stage, form, dictionary, processes, progress: new ProgressStrip() });

async function load() {
    try {
        await processes.load(connection.api);
    } catch (error) {
        if (error.status === 401) connection.ask(error.detail);
        show_fault(error);
    }
    await jobs.show(connection.api);
}

stage.on_choice = (mode) => mode !== 'atom' && dictionary.mark(null);
start_theme((theme, background) => stage.set_theme(theme, background));
start_tabs((name) => name === 'jobs' && jobs.show(connection.api));
show_samples(by_id('samples'), (name) => app.open_sample(name));
accept_files((file) => app.open_file(file));
dictionary.clear();
show_no_result(by_id('panel-result'));
by_id('run').addEventListener('click', () => app.run());
by_id('inputs').addEventListener('submit', (event) => event.preventDefault());
by_id('reference').addEventListener('click', () => by_id('reference-file').click());
by_id('reference-file').addEventListener('change', ({ target }) => {
    if (target.files.length) app.open_reference(target.files[0]);
    target.value = '';
});
load();
