/** Elements of the page. What the data says enters it as text only. */

/**
 * @param {string} tag
 * @param {Object<string, string|number|boolean|Function>} [properties] `class`, `text`, `on...` listeners,
 *   else attributes
 * @param {...Node} children
 */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === false) continue;
    if (name === 'text') made.textContent = String(value);
    else if (name === 'class') made.className = String(value);
    else if (name.startsWith('on'))
      made.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    else made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children);
  return made;
}

/** Sets the text where it differs: while a recording plays most of it stays. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** The heading of a section, with what stands beside it. */
export function heading(text, ...beside) {
  return element('div', { class: 'section-head' }, element('h2', { text }), ...beside);
}

/** A table that scrolls by itself, with the keyboard too where nothing in it takes the focus. */
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

/** A cell with a number: what is shown, its exact value to point at and to read by machine. */
export function numberCell(text, exact, tag = 'td') {
  return element(tag, { class: 'number', text, 'data-value': exact, title: exact });
}
