/**
 * Makes an element.
 * @param {string} tag "div", or "button.primary" with classes
 * @param {object} [properties] attributes; `on...` are listeners
 * @param {...(Node|string|null|undefined|false)} children
 * @returns {HTMLElement}
 */
export function element(tag, properties = {}, ...children) {
    const [name, ...classes] = tag.split('.');
    const made = document.createElement(name);
    if (classes.length) made.className = classes.join(' ');
    set_attributes(made, properties);
    made.append(...children.filter((child) => child || child === 0));
    return made;
}

/** The same for SVG. */
export function svg_element(tag, properties = {}, ...children) {
    const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
    set_attributes(made, properties);
    made.append(...children);
    return made;
}

function set_attributes(target, properties) {
    for (const [name, value] of Object.entries(properties)) {
        if (name.startsWith('on')) target.addEventListener(name.slice(2), value);
        else if (value === true) target.setAttribute(name, '');
        else if (value !== false && value !== undefined && value !== null) {
            target.setAttribute(name, value);
        }
    }
}

/** @returns {HTMLElement} the element with this id */
export const by_id = (id) => document.getElementById(id);
