/** The names of replays and of the page. */

const SHORT = 60; // characters of a title

/** The name of a replay, with its number if another replay has the same name. */
export function nameOf(report, index) {
  const { name } = report.summaries[index];
  const same = report.summaries.filter((other) => other.name === name).length;
  return same > 1 ? `${name} (${index + 1})` : name;
}

const withoutFolders = (path) => path.slice(path.lastIndexOf('/') + 1);

/** The name of a replay without its folders, unless another one then has the same. */
export function shortNameOf(report, index) {
  const short = report.summaries.map(({ name }) => withoutFolders(name));
  return short.filter((name) => name === short[index]).length > 1 ? nameOf(report, index) : short[index];
}

/** The title of a comparison: the files of its replays, if that is short. */
export function titleOf(report) {
  if (report.kind !== 'compare') return report.title;
  const files = report.summaries.map(({ name }) => withoutFolders(name));
  const unique = new Set(files).size === files.length;
  const names = (unique ? files : report.summaries.map((_, index) => nameOf(report, index))).join(', ');
  return names.length <= SHORT ? names : `Comparison of ${report.summaries.length} replays`;
}
