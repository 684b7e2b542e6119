// Bundles the pages into ../template.html and ../jobs.html: a file each, with the hash of these sources and the licences of
// what is in it.
import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const sha256 = (bytes, form) => createHash('sha256').update(bytes).digest(form);

function sourceFiles(folder) {
  return readdirSync(folder, { withFileTypes: true })
    .filter((entry) => entry.name !== 'node_modules')
    .flatMap((entry) => {
      const path = join(folder, entry.name);
      return entry.isDirectory() ? sourceFiles(path) : [path];
    });
}

/** As `sources.sh` computes it, for machines without node. */
function hashOfSources() {
  const names = sourceFiles(here).map((path) => relative(here, path)).sort();
  const lines = names.map((name) => `${sha256(readFileSync(join(here, name)), 'hex')}  ./${name}\n`);
  return sha256(lines.join(''), 'hex');
}

async function bundle(entry) {
  const result = await build({
    entryPoints: [join(here, entry)],
    bundle: true,
    minify: true,
    charset: 'utf8',
    target: ['chrome103', 'firefox115', 'safari16.4'],
    format: 'iife',
    legalComments: 'none', // the licences travel in full
    metafile: true,
    write: false,
    logLevel: 'warning',
  });
  const text = result.outputFiles[0].text.trim();
  return { text, inputs: Object.keys(result.metafile.inputs) };
}

function licenceOf(name) {
  const folder = join(here, 'node_modules', name);
  const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const file = readdirSync(folder).find((candidate) => /^licen[cs]e/i.test(candidate));
  if (file === undefined) throw new Error(`${name} carries no licence text`);
  return `${name} ${version}\n\n${readFileSync(join(folder, file), 'utf8').trim()}`;
}

/** Of every package of which a file is in the bundle. */
function licences(inputs) {
  const own = `cscd\n\n${readFileSync(join(here, '../../../LICENSE'), 'utf8').trim()}`;
  const names = inputs.map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]);
  const packages = [...new Set(names.filter((name) => name !== undefined))].sort();
  return [own, ...packages.map(licenceOf)].join('\n\n----\n\n');
}

function safeInElement(text, what) {
  if (/<\/(script|style)|<!--/i.test(text)) throw new Error(`the ${what} would end its element early`);
  return text;
}

async function makePage(folder, html) {
  const script = await bundle(join(folder, 'main.js'));
  const style = await bundle(join(folder, 'style.css'));
  const policy = [
    "default-src 'none'",
    `script-src 'sha256-${sha256(script.text, 'base64')}'`,
    `style-src 'sha256-${sha256(style.text, 'base64')}'`,
    'img-src data: blob:',
    // Neither of these falls back to default-src: a name in a recording could otherwise move what links
    // lead to, or send a form.
    "base-uri 'none'",
    "form-action 'none'",
  ].join('; ');
  const parts = {
    policy:
      `<meta http-equiv="Content-Security-Policy" content="${policy}">\n` +
      `<meta name="cscd-report-sources" content="${hashOfSources()}">`,
    style: `<style>${safeInElement(style.text, 'style')}</style>`,
    licences:
      `<script type="text/plain" id="licence-texts">\n` +
      `${safeInElement(licences([...script.inputs, ...style.inputs]), 'licences')}\n</script>`,
    script: `<script>${safeInElement(script.text, 'script')}</script>`,
  };
  let page = readFileSync(join(here, folder, 'index.html'), 'utf8');
  for (const [name, text] of Object.entries(parts)) {
    const mark = `<!--cscd:${name}-->`;
    if (page.split(mark).length !== 2) throw new Error(`${folder}/index.html needs ${mark} once`);
    page = page.replace(mark, () => text);
  }
  const marks = page.split('\n').filter((line) => line === '<!--cscd:data-->');
  if (marks.length !== 1) throw new Error(`${folder}/index.html needs the line <!--cscd:data--> once`);
  writeFileSync(join(here, '..', html), page);
  console.log(`${html}: ${page.length} characters, of which the script ${script.text.length}`);
}

await makePage('.', 'template.html');
await makePage('jobs', 'jobs.html');
