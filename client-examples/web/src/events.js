/** One `name: value` line of an event; a line without a colon is a name alone. */
function read_line(event, line) {
    const colon = line.indexOf(':');
    if (colon === 0) return;
    const name = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? '' : line.slice(colon + 1).replace(/^ /, '');
    if (name === 'data') event.data = event.data === undefined ? value : `${event.data}\n${value}`;
    if (name === 'event') event.name = value;
    if (name === 'id') event.id = value;
}

/**
 * Reads an event stream through fetch: EventSource cannot send a key in a header.
 * @param {Response} response
 * @returns {AsyncGenerator<{name: string, data: string, id: string|undefined}>}
 */
export async function* read_events(response) {
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let text = '';
    let event = { name: 'message' };
    try {
        for (;;) {
            const { done, value } = await reader.read();
            if (done) return;
            const lines = (text + value).split(/\r\n|\n|\r/);
            text = lines.pop();
            for (const line of lines) {
                if (line) {
                    read_line(event, line);
                } else {
                    if (event.data !== undefined) yield event;
                    event = { name: 'message' };
                }
            }
        }
    } finally {
        reader.cancel().catch(() => {});
    }
}
