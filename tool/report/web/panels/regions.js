/** The regions of the plan, and the times of preprocessing. */
import { element, heading, numberCell, scrollable, swatch } from '../page/dom.js';
import { coordinates, counted, decimal, integer, percent, positionDecimals, significant } from '../page/format.js';
import { css, regionColour } from '../view/colours.js';

function regionRow(region, index, { area, unit, decimals }) {
  const name = element('th', { scope: 'row' }, swatch(css(regionColour(index))), ` ${index}`);
  const share = area > 0 ? region.area / area : 0;
  const point = region.detector_point.map((value) => value * unit);
  return element(
    'tr',
    {},
    name,
    numberCell(integer(region.component), region.component),
    numberCell(integer(region.triangles), region.triangles),
    numberCell(percent(share), share),
    numberCell(percent(region.visible_share), region.visible_share),
    element('td', {
      class: 'number',
      text: coordinates(point, decimals),
      title: point.join(' '),
      'data-value': point.join(' '),
    }),
  );
}

function regionTable(plan, unit) {
  const head = element('tr');
  for (const [text, number, title] of [
    ['region'],
    ['component', true],
    ['triangles', true],
    ['share of area', true],
    ['visible share', true, 'Share of the region that its detector point sees at rest'],
    ['detector point', true, 'x, y, z at rest'],
  ])
    head.append(element('th', { scope: 'col', text, title, class: number ? 'number' : undefined }));
  const area = plan.regions.reduce((sum, region) => sum + region.area, 0);
  const decimals = positionDecimals(plan.regions.map((region) => region.detector_point).flat(), unit);
  const body = element(
    'tbody',
    {},
    ...plan.regions.map((region, index) => regionRow(region, index, { area, unit, decimals })),
  );
  return scrollable(element('table', { 'aria-label': 'Regions' }, element('thead', {}, head), body));
}

function facts(pairs, label) {
  const body = element('tbody');
  for (const [name, text, exact] of pairs)
    body.append(element('tr', {}, element('th', { scope: 'row', text: name }), numberCell(text, exact)));
  return element('table', { 'aria-label': label }, body);
}

function capacitances(values) {
  const table = facts(
    values.map((value, component) => [
      values.length > 1 ? `Capacitance of component ${component}` : 'Capacitance',
      significant(value, 6),
      value,
    ]),
    'Capacitances',
  );
  return scrollable(table);
}

const PHASES = [
  ['assembly_ms', 'Assembly of the matrix'],
  ['solve_ms', 'Solution for the charge'],
  ['regions_ms', 'Regions and points'],
  ['total_ms', 'All of preprocessing'],
];

function phases(timings) {
  const known = PHASES.filter(([key]) => timings[key] !== undefined);
  return facts(
    known.map(([key, name]) => [name, `${decimal(timings[key], 3)} ms`, timings[key]]),
    'Timings of preprocessing',
  );
}

export function create(container, report) {
  const plan = report.scene?.plan;
  container.hidden = !plan && !report.preprocess;
  if (container.hidden) return;
  const words = plan ? `${counted(plan.regions.length, 'region')} by ${plan.method}` : 'no plan';
  container.append(heading('Regions', element('span', { class: 'quiet', text: words })));
  if (plan) container.append(regionTable(plan, report.scene.unit));
  if (plan?.capacitances?.length > 0) {
    container.append(
      capacitances(plan.capacitances),
      element('p', {
        class: 'quiet',
        text: "Capacitance: the charge at potential 1, a length in the files' unit (Gaussian units).",
      }),
    );
  }
  if (report.preprocess?.timings) container.append(phases(report.preprocess.timings));
}
