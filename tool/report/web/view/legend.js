/** The legend over the view: what colours and marks mean, in words and numbers. */

import { onCalmly } from '../controls/calm.js';
import { element, swatch } from '../page/dom.js';
import { counted, integer, percent, significant } from '../page/format.js';
import { finder, intervalAt } from '../page/intervals.js';
import {
  DEPTH, DISPLACEMENT, HEAT, INTERSECTING, ONLY_TOUCHING, ORIENTATIONS, PLAIN, TOUCHING, VIRIDIS, css, regionColour,
} from './colours.js';

const MANY = 8;
const ROOMY = { width: 560, height: 380 }; // CSS pixels: in smaller views the legend begins folded

const short = (value) => significant(value, 3).replace('-', '−');

function bar(map) {
  const canvas = element('canvas', { class: 'legend-bar', width: 256, height: 1, 'aria-hidden': 'true' });
  const context = canvas.getContext('2d');
  for (let i = 0; i < 256; i++) {
    context.fillStyle = css([...map.subarray(3 * i, 3 * i + 3)]);
    context.fillRect(i, 0, 1, 1);
  }
  return canvas;
}

const ends = (...texts) => element('div', { class: 'legend-ends' }, ...texts.map((text) => element('span', {}, text)));

const item = (mark, ...text) => element('li', {}, mark, ' ', ...text);
const items = (...list) => element('ul', { class: 'legend-items' }, ...list);
const title = (text) => element('div', { class: 'legend-title' }, text);

function chargeLegend(limits) {
  const { low, high, below, above, least, most } = limits;
  const [first, last] = [`${below ? '≤\u202f' : ''}${short(low)}`, `${above ? '≥\u202f' : ''}${short(high)}`];
  const range = `from ${short(least)} to ${short(most)}; 2\u202f% of the triangles at either end share a colour`;
  return [
    title('Charge per area at potential 1 (Gaussian units: 1/length)'),
    bar(VIRIDIS),
    ends(first, short((low + high) / 2), last),
    ...(below || above ? [element('p', { class: 'legend-note' }, range)] : []),
  ];
}

const equalizedLegend = () => [
  title('Rank of the charge within its component'),
  bar(VIRIDIS),
  ends('0 least', '0.5', '1 most'),
];

function regionLegend(plan) {
  const rows = plan.regions.slice(0, MANY).map((region, i) => {
    const visible = region.visible_share == null ? '' : `, ${percent(region.visible_share, 0)}`;
    return item(swatch(css(regionColour(i))), `${i}: ${integer(region.triangles)}${visible}`);
  });
  const rest = plan.regions.length - rows.length;
  return [
    title(`${counted(plan.regions.length, 'region')} (${plan.method})`),
    element('p', { class: 'legend-note' }, 'Triangles, and the share that the detector point sees'),
    items(...rows, ...(rest > 0 ? [element('li', {}, `and ${integer(rest)} more; colours repeat after 21`)] : [])),
  ];
}

function orientationLegend(scene, time) {
  const interval = intervalAt(time, scene);
  const values = scene.orientation.at(interval);
  const counts = [0, 0, 0];
  for (const value of values) counts[value]++;
  const told = scene.orientation.interval(interval);
  return [
    title(`Orientation in interval ${told}, seen from each region's detector point`),
    items(
      item(swatch(css(ORIENTATIONS[1])), `S+ faces outwards throughout: ${integer(counts[1])}`),
      item(swatch(css(ORIENTATIONS[2])), `S− faces inwards throughout: ${integer(counts[2])}`),
      item(swatch(css(ORIENTATIONS[0])), `S0 turns, or cannot be told: ${integer(counts[0])}`),
    ),
  ];
}

function heatLegend(most, info) {
  if (most === 0) return [title('No triangle takes part in a contact')];
  const all = info !== null && info.kept < info.found ? ' (of all found, also those not kept)' : '';
  return [
    title(`Contacts that a triangle takes part in, whole recording${all}`),
    bar(HEAT),
    ends('1', ...(most > 8 ? [integer(Math.round(Math.sqrt(most)))] : []), integer(most)),
    items(item(swatch(css(PLAIN)), 'none')),
  ];
}

/** Rows for the VF and EE contacts of the interval, and for the other marks. */
function marksLegend(scene, state, find) {
  const rows = [];
  if (state.contacts && scene.contacts !== null) {
    const interval = intervalAt(state.time, scene);
    const [begin, end] = scene.contacts.range(interval);
    const kept = [0, 0];
    for (let contact = begin; contact < end; contact++) kept[scene.contacts.kind[contact]]++;
    const row = find(interval);
    const count = (kind, all) => (kept[kind] < all ? `${integer(kept[kind])} of ${integer(all)}` : integer(kept[kind]));
    const mark = (name) => element('span', { class: name, 'aria-hidden': 'true' });
    rows.push(item(mark('mark-vf'), `VF, a vertex touches a face: ${count(0, row?.vf)}`));
    rows.push(item(mark('mark-ee'), `EE, two edges touch: ${count(1, row?.ee)}`));
    const how = state.colour === 'plain' ? 'triangles in contact' : 'outlined: triangles in contact';
    if (end > begin) rows.push(item(swatch(css(TOUCHING)), how));
  }
  return rows.length > 0 ? [items(...rows)] : [];
}

/** "in frame 12", or "before in frame 12" where a page shows both. */
function whenOf(scene, state) {
  const frame = `in frame ${scene.answers.numberOf(scene.answers.placeOf(state))}`;
  if (scene.displacement === null) return frame;
  const side = state.share < 0.5 ? 'before' : 'after';
  return scene.numbers.length > 1 ? `${side} ${frame}` : side;
}

function displacementLegend({ displacement, lengthUnit, unit }) {
  if (displacement.most === 0) return [title('No vertex moved')];
  const most = displacement.most * unit;
  return [
    title(`How far vertices moved, in ${lengthUnit ?? 'the unit of the file'}`),
    bar(DISPLACEMENT),
    ends('0', short(most / 2), short(most)),
  ];
}

/** What the fills of the frame mean, with the depths in the file's unit. */
function answersLegend(scene, state) {
  const { answers: all, unit } = scene;
  const found = state.answers && all !== null ? all.at(all.placeOf(state)) : null;
  if (found === null) return [];
  const rows = [];
  if (found.crossing > 0) rows.push(item(swatch(css(INTERSECTING)), `intersecting: ${counted(found.crossing, 'pair')} of triangles`));
  if (found.touching > 0) rows.push(item(swatch(css(ONLY_TOUCHING)), `touching: ${counted(found.touching, 'pair')}`));
  if (found.curveShares.length > 0) rows.push(item(element('span', { class: 'mark-curve', 'aria-hidden': 'true' }), 'intersection curves'));
  const parts = [title(`What intersects ${whenOf(scene, state)}`), items(...rows)];
  if (found.depths.length === 0) return parts;
  return [
    ...parts,
    title(`Depth of what is buried, in ${scene.lengthUnit ?? 'the unit of the file'}`),
    bar(DEPTH),
    ends('0', short((all.deepest * unit) / 2), short(all.deepest * unit)),
  ];
}

function colourLegend(scene, state, painter) {
  switch (state.colour) {
    case 'charge':
      return chargeLegend(painter.limits);
    case 'equalized':
      return equalizedLegend();
    case 'region':
      return regionLegend(scene.plan);
    case 'orientation':
      return orientationLegend(scene, state.time);
    case 'displacement':
      return displacementLegend(scene);
    case 'heat':
      return heatLegend(painter.mostHeat, scene.contactsInfo);
    default:
      return [];
  }
}

/** @param {import('./paint.js').Painter} painter */
export function createLegend(container, report, store, painter) {
  const { scene } = report;
  const find = finder(report.summaries[0]?.summary);
  const body = element('div', { class: 'legend-body' });
  const box = element('details', { class: 'legend', role: 'group', 'aria-label': 'Legend' });
  box.append(element('summary', {}, 'Legend'), body);
  box.open = container.clientWidth >= ROOMY.width && container.clientHeight >= ROOMY.height;
  container.append(box);
  let shown = null;
  const show = (state) => {
    const frame = scene.answers === null ? '' : scene.answers.placeOf(state);
    const key = [state.colour, state.contacts, state.answers, frame, intervalAt(state.time, scene)].join(' ');
    if (key === shown) return;
    shown = key;
    const parts = [...answersLegend(scene, state), ...colourLegend(scene, state, painter), ...marksLegend(scene, state, find)];
    body.replaceChildren(...parts);
    box.hidden = parts.length === 0;
  };
  onCalmly(store, ['time', 'share', 'colour', 'contacts', 'answers'], show);
  show(store.get());
}
