/** Elements without markup: text is always text. */

/** element('button', {class: 'icon', type: 'button'}, 'text', child, ...) */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(key, '');
    else if (value !== false && value !== null) made.setAttribute(key, String(value));
  }
  made.append(...children);
  return made;
}

const SVG = 'http://www.w3.org/2000/svg';

/** A glyph drawn by one path in a square of 16. */
export function icon(path) {
  const svg = document.createElementNS(SVG, 'svg');
  for (const [key, value] of [['viewBox', '0 0 16 16'], ['width', '16'], ['height', '16'], ['aria-hidden', 'true']]) {
    svg.setAttribute(key, value);
  }
  const shape = document.createElementNS(SVG, 'path');
  shape.setAttribute('d', path);
  shape.setAttribute('fill', 'currentColor');
  svg.append(shape);
  return svg;
}

/** A button with an accessible name and a title that tells its key. */
export function button(name, { glyph = null, key = null, kind = 'icon' }, action) {
  const title = key === null ? name : `${name} (${key})`;
  const made = element('button', { type: 'button', class: kind, 'aria-label': name, title });
  made.append(glyph === null ? name : icon(glyph));
  made.addEventListener('click', action);
  return made;
}
