import { element } from './dom.js';
import { short_number } from './numbers.js';

/** What may be entered besides "auto". */
function value_schema(schema) {
    return schema.oneOf?.find((one) => one.const !== 'auto') ?? schema;
}

const is_number = (schema) => ['number', 'integer'].includes(value_schema(schema).type);

/** Numbers first, then choices, then texts: the server names its inputs in no special order. */
function rank({ schema }) {
    return is_number(schema) ? 0 : schema.enum ? 1 : 2;
}

function number_input(schema, common) {
    const { type, minimum, maximum } = value_schema(schema);
    return element('input', { ...common, type: 'number', step: type === 'integer' ? 1 : 'any',
        min: minimum, max: maximum, placeholder: 'auto' });
}

function control(name, schema) {
    const common = { id: `input-${name}`, name, 'aria-describedby': `hint-${name}` };
    if (schema.enum) {
        return element('select', common, ...schema.enum.map((value) =>
            element('option', { value, selected: value === schema.default }, value)));
    }
    if (is_number(schema)) return number_input(schema, common);
    return element('input', { ...common, type: 'text', placeholder: 'auto', spellcheck: 'false',
        pattern: value_schema(schema).pattern });
}

function row(name, { title, schema }) {
    const unit = schema['x-unit'] ? ` [${schema['x-unit']}]` : '';
    return element('div.parameter', { 'data-name': name },
        element('label', { for: `input-${name}` }, `${title}${unit}`),
        control(name, schema),
        element('p.hint', { id: `hint-${name}` },
            element('span', {}, schema.description), ' ',
            element('span.auto', { 'data-rule': schema['x-auto'] ?? '' }, schema['x-auto'] ?? ''),
            element('span.fault', {})));
}

/** The inputs of a process as a form, made from the JSON Schema that the server gives. */
export class ParameterForm {
    /** @param {HTMLElement} place @param {() => void} changed */
    constructor(place, changed) {
        this.place_ = place;
        place.addEventListener('change', () => {
            this.clear_faults();
            changed();
        });
    }

    /** @param {object} process what GET /v1/processes/{id} answers */
    show(process) {
        const kept = this.values();
        const inputs = Object.entries(process.inputs).filter(([name]) => name !== 'shape')
            .sort(([, a], [, b]) => rank(a) - rank(b));
        this.place_.replaceChildren(...inputs.map(([name, input]) => row(name, input)));
        for (const [name, value] of Object.entries(kept)) {
            const field = this.field_(name);
            if (field) field.value = value;
        }
    }

    /** @returns {object} the inputs that are not automatic */
    values() {
        const values = {};
        for (const field of this.place_.querySelectorAll('input, select')) {
            const text = field.value.trim();
            if (text && text !== 'auto') values[field.name] = field.type === 'number' ? Number(text) : text;
        }
        return values;
    }

    /** Shows what the automatic ones come to, and by which rule. */
    show_resolved(resolved) {
        for (const rule of this.place_.querySelectorAll('.auto')) rule.textContent = rule.dataset.rule;
        for (const [name, { value, source, rule }] of Object.entries(resolved ?? {})) {
            const field = this.field_(name);
            if (!field || source !== 'auto') continue;
            const shown = typeof value === 'number' ? short_number(value) : value;
            field.placeholder = `auto: ${shown}`;
            this.row_(name).querySelector('.auto').textContent = `Here: ${shown}. ${rule}.`;
        }
    }

    /**
     * Marks the inputs that a problem points at.
     * @param {{pointer: string, detail: string}[]} errors
     * @param {{focus: boolean}} [then] whether the first of them gets the focus
     * @returns {boolean} whether there was one
     */
    show_faults(errors, { focus } = { focus: true }) {
        const named = errors.map(({ pointer, detail }) => ({ name: pointer.split('/').at(-1), detail }))
            .filter(({ name }) => this.field_(name));
        for (const { name, detail } of named) {
            this.field_(name).setAttribute('aria-invalid', 'true');
            this.row_(name).querySelector('.fault').textContent = detail;
        }
        if (named.length && focus) {
            this.place_.closest('details').open = true;
            this.field_(named[0].name).focus();
        }
        return named.length > 0;
    }

    clear_faults() {
        for (const fault of this.place_.querySelectorAll('.fault')) fault.textContent = '';
        for (const field of this.place_.querySelectorAll('[aria-invalid]')) {
            field.removeAttribute('aria-invalid');
        }
    }

    row_(name) {
        return this.place_.querySelector(`[data-name="${CSS.escape(name)}"]`);
    }

    field_(name) {
        return this.row_(name)?.querySelector('input, select');
    }
}
