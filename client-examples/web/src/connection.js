import { Api } from './api.js';
import { by_id } from './dom.js';

const KEY = 'lpf-key';
const SERVER = 'lpf-server';

function read(storage, name) {
    try {
        return storage.getItem(name) ?? '';
    } catch {
        return '';
    }
}

function write(storage, name, value) {
    try {
        if (value) storage.setItem(name, value);
        else storage.removeItem(name);
    } catch {
        // Without storage it lasts as long as the page.
    }
}

/** Where the service is: ?server= in the address, what was used before, or where the page is from. */
function stored_connection() {
    const asked = new URLSearchParams(location.search).get('server');
    const server = asked || read(localStorage, SERVER) || location.origin;
    return { server, key: read(sessionStorage, KEY) };
}

/** The dialog that asks for server and key. */
export class Connection {
    /** @param {(api: Api) => void} changed */
    constructor(changed) {
        this.dialog_ = by_id('connection');
        this.api = new Api(stored_connection());
        by_id('connect').addEventListener('click', () => this.ask());
        by_id('connection-close').addEventListener('click', () => this.dialog_.close());
        this.dialog_.querySelector('form').addEventListener('submit', () => {
            const key = by_id('key').value.trim();
            const server = new URL(by_id('server').value || location.origin).origin;
            write(sessionStorage, KEY, key);
            write(localStorage, SERVER, server === location.origin ? '' : server);
            this.api = new Api({ server, key });
            changed(this.api);
        });
    }

    /** @param {string} [why] what to say about it */
    ask(why = '') {
        by_id('server').value = this.api.server;
        by_id('key').value = this.api.key;
        by_id('connection-state').textContent = why;
        if (!this.dialog_.open) this.dialog_.showModal();
        if (why) by_id('key').focus();
    }
}
