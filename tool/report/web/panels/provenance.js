/** Names the origin of the results (version, machine, inputs), and how exactly this page shows them. */
import { element, heading } from '../page/dom.js';
import { counted, integer, significant } from '../page/format.js';
import { nameOf } from '../page/names.js';

const lines = (texts) => texts.map((text) => element('div', { text }));
const code = (text) => element('code', { text });

function machineWords({ system, release, architecture, processor, processors }) {
  return [processor, counted(processors, 'processor'), `${system} ${release}, ${architecture}`].filter(
    Boolean,
  );
}

/** The arguments, quoted for a shell. */
function commandLine(args) {
  return [
    'cscd',
    ...args.map((word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`)),
  ].join(' ');
}

function planWords(plan) {
  if (plan.source === 'none') return 'none';
  const from =
    plan.source === 'file'
      ? `from ${plan.path}`
      : plan.made_ms === undefined
        ? 'made by this replay'
        : `made by this replay in ${significant(plan.made_ms, 4)} ms`;
  return `${counted(plan.regions, 'region')} by ${plan.method}, ${from}`;
}

/** What `--reproducible` leaves out. */
const factsOfMoment = ({ date, machine, threads, arguments: words }) => [
  ['Date', lines([date])],
  ['Machine', lines(machineWords(machine))],
  ['Threads', lines([integer(threads)])],
  ['Command', [code(commandLine(words))]],
];

/** The rows [name, nodes] of one run. */
function factsOfRun(provenance) {
  const facts = [
    ['Version', lines([`cscd ${provenance.version}, commit ${provenance.commit}`])],
    ['Compiler', lines([`${provenance.compiler} ${provenance.flags}`])],
  ];
  if (provenance.date !== undefined) facts.push(...factsOfMoment(provenance));
  const inputs = (provenance.inputs ?? []).map(({ name, fnv1a64 }) =>
    element('div', {}, `${name} `, code(fnv1a64)),
  );
  if (inputs.length > 0) facts.push(['Inputs (FNV-1a)', inputs]);
  if (provenance.frame_paths?.length > 1)
    facts.push([
      'Frames from',
      lines([`${provenance.frame_paths[0]} and ${counted(provenance.frame_paths.length - 1, 'other file')}`]),
    ]);
  return facts;
}

function factsOfMethod(summary) {
  return [
    [
      'Method',
      lines([
        `${summary.method}, mode ${summary.mode}`,
        `bounding volumes: ${summary.volume}` +
          (summary.simd === undefined ? '' : `, vector instructions: ${summary.simd}`),
      ]),
    ],
    [
      'Least separation',
      lines([
        summary.min_separation === 0
          ? '0: features in contact touch'
          : `${summary.min_separation}: a contact is coming within it`,
      ]),
    ],
    ['Plan', lines([planWords(summary.plan)])],
    [
      'Mesh',
      lines([
        `${counted(summary.vertices, 'vertex', 'vertices')}, ${counted(summary.triangles, 'triangle')}, ` +
          counted(summary.components, 'component'),
      ]),
    ],
  ];
}

/** The largest distance between what is drawn and what was computed. */
function factsOfPicture(scene) {
  const all = scene.numbers.length;
  const kept = scene.frames.length;
  const shown =
    kept === all
      ? all === 1
        ? 'the mesh at rest'
        : `all ${integer(all)}`
      : `${integer(kept)} of ${integer(all)}; straight lines between them`;
  const relative =
    scene.relativeError === null
      ? ''
      : `, ${significant(scene.relativeError, 3)} of the longest side of the mesh's box`;
  const error =
    `Drawn positions are at most ${significant(scene.maxError, 3)} off along x, y or z, ` +
    `in the files' unit${relative}. Numbers in tables are not rounded by this.`;
  return [
    ['Frames drawn', lines([shown])],
    ['Precision', lines([error])],
  ];
}

function tableOf(facts, label) {
  const body = element('tbody');
  for (const [name, nodes] of facts)
    body.append(element('tr', {}, element('th', { scope: 'row', text: name }), element('td', {}, ...nodes)));
  return element('table', { 'aria-label': label }, body);
}

export function create(container, report) {
  container.append(heading('Provenance', element('span', { class: 'quiet', text: report.generator })));
  if (report.kind === 'compare') {
    report.summaries.forEach(({ summary }, index) => {
      const facts = [...factsOfRun(summary.provenance), ...factsOfMethod(summary.summary)];
      container.append(
        element(
          'details',
          {},
          element('summary', { text: nameOf(report, index) }),
          tableOf(facts, `Provenance of ${nameOf(report, index)}`),
        ),
      );
    });
    return;
  }
  const run = report.summaries[0]?.summary;
  const provenance = run?.provenance ?? report.preprocess?.provenance;
  container.append(
    tableOf(
      [
        ...(provenance ? factsOfRun(provenance) : []),
        ...(run ? factsOfMethod(run.summary) : []),
        ...(report.scene ? factsOfPicture(report.scene) : []),
      ],
      'Provenance',
    ),
  );
}
