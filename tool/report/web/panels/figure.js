/** A chart with its title, its key, which also reads values, and its mean and maximum in words. */
import { element, setText, swatch } from '../page/dom.js';
import { createPlot } from './plot.js';

/**
 * @param {{title: string, summary: string, read: (value: number) => string, total?: ArrayLike<number>,
 *          series: object[], mark?: (index: number) => Node}} figure and the options of createPlot
 */
export function createFigure(figure) {
  const { title, series, read, total } = figure;
  const outputs = [];
  const keys = element('ul', { class: 'chart-keys' });
  const addKey = (mark, label, more) => {
    const output = element('output', { class: 'number', 'aria-live': 'off' });
    outputs.push(output);
    keys.append(
      element(
        'li',
        {},
        ...mark,
        element('span', { text: label }),
        output,
        ...(more ? [element('small', { text: more })] : []),
      ),
    );
  };
  for (const { label, colour, mark, summary } of series)
    addKey([mark ?? swatch(colour.startsWith('--') ? `var(${colour})` : colour)], label, summary);
  if (total) addKey([], 'total');
  const host = element('div', { class: 'plot' });
  const box = element(
    'figure',
    { class: 'chart', 'aria-label': title },
    element(
      'figcaption',
      {},
      element('h3', { text: title }),
      element('span', { class: 'quiet', text: figure.summary }),
    ),
    keys,
    host,
  );

  return {
    box,
    host,
    /** It can be drawn only when the page has a width. */
    draw: (attach) => createPlot(host, figure, attach),
    /** Shows the values of this interval, counted from the first. */
    show(interval) {
      const columns = total
        ? [...series.map(({ values }) => values), total]
        : series.map(({ values }) => values);
      columns.forEach((values, i) => {
        const value = values[interval];
        setText(outputs[i], value === undefined || value === null ? '–' : read(value));
      });
    },
  };
}
