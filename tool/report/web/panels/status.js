/** The line that says where the recording stands. */
import { onCalmly } from '../controls/calm.js';
import { setText } from '../page/dom.js';
import { counted, integer, moment } from '../page/format.js';
import { extentOf, finder, intervalAt } from '../page/intervals.js';
import { STATE_NAME } from '../page/states.js';

function ofStill(report) {
  if (report.kind === 'compare') return `${counted(report.summaries.length, 'replay')} compared`;
  const { vertexCount, triangleCount, plan } = report.scene;
  const size = `${counted(triangleCount, 'triangle')}, ${counted(vertexCount, 'vertex', 'vertices')}`;
  return plan ? `${size}, ${counted(plan.regions.length, 'region')}` : size;
}

export function create(container, report, store) {
  const still = report.kind !== 'replay' && report.untangled === null;
  if (still || (report.untangled !== null && report.scene.last === report.scene.first)) {
    container.textContent = ofStill(report);
    return;
  }
  const extent = extentOf(report);
  const { first, last } = extent;
  const { fps } = report.scene;
  const find = finder(report.summaries[0]?.summary);

  function update({ time, playing }) {
    container.setAttribute('aria-live', playing ? 'off' : 'polite');
    const seconds = fps === null ? '' : ` (${(time / fps).toFixed(2)} s)`;
    const parts = [`Frame ${moment(time)}${seconds} of ${first} to ${last}`];
    const interval = find(intervalAt(time, extent));
    if (interval) {
      parts.push(STATE_NAME[interval.state] ?? interval.state);
      parts.push(`${integer(interval.vf)} VF, ${integer(interval.ee)} EE`);
    }
    setText(container, parts.join(' · '));
  }

  onCalmly(store, ['time'], update);
  update(store.get());
}
