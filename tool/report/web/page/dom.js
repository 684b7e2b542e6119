/** Makes elements of the page. Data enters them as text only, never as markup. */

/**
 * @param {string} tag
 * @param {Object<string, string|number|boolean|null|Function>} [properties] `class`, `text`, `on...` listeners,
 *   else attributes; false, null and undefined leave one out
 * @param {...(Node|string)} children
 */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'text') made.textContent = String(value);
    else if (name === 'class') made.className = String(value);
    else if (name.startsWith('on'))
      made.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    else made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children);
  return made;
}

const SVG = 'http://www.w3.org/2000/svg';

/** An inline picture of one shape, which screen readers skip. */
export function picture(width, height, name, attributes) {
  const make = (tag, given) => {
    const made = document.createElementNS(SVG, tag);
    for (const [key, value] of Object.entries(given)) made.setAttribute(key, String(value));
    return made;
  };
  const svg = make('svg', { viewBox: `0 0 ${width} ${height}`, width, height, 'aria-hidden': true });
  svg.append(make(name, attributes));
  return svg;
}

/** A glyph drawn by one path in a square of 16. */
export const icon = (path) => picture(16, 16, 'path', { d: path, fill: 'currentColor' });

/** A button with an accessible name and a title that tells its key. */
export function button(name, { glyph = null, key = null, kind = 'icon' }, action) {
  const title = key === null ? name : `${name} (${key})`;
  const content = glyph === null ? name : icon(glyph);
  return element('button', { type: 'button', class: kind, 'aria-label': name, title, onclick: action }, content);
}

/** A square in a colour, which a key names beside it. */
export function swatch(colour) {
  const made = element('span', { class: 'swatch', 'aria-hidden': 'true' });
  made.style.background = colour;
  return made;
}

/** Sets the text only if it differs, because most of it stays while a recording plays. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** The heading of a section, with elements beside it. */
export function heading(text, ...beside) {
  return element('div', { class: 'section-head' }, element('h2', { text }), ...beside);
}

/** A table that scrolls by itself, also with the keyboard if nothing in it takes the focus. */
export function scrollable(table) {
  const label = `${table.getAttribute('aria-label')}, scrolls`;
  return element('div', { class: 'scroll', tabindex: 0, role: 'group', 'aria-label': label }, table);
}

/** A group of radio buttons, drawn as one segmented switch; choose(value) when one is taken. */
export function segments(label, name, options, chosen, choose) {
  const group = element('div', { class: 'segments', role: 'radiogroup', 'aria-label': label });
  for (const [value, text] of options) {
    const radio = element('input', { type: 'radio', name, value, onchange: () => choose(value) });
    radio.checked = value === chosen;
    group.append(element('label', {}, radio, element('span', { text })));
  }
  return group;
}

/** A cell with a rounded number, and the exact value for the pointer and for programs. */
export function numberCell(text, exact, tag = 'td') {
  return element(tag, { class: 'number', text, 'data-value': exact, title: exact });
}
