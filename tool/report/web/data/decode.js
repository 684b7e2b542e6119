/** The data blocks of the page, base64 of zlib streams, as typed arrays. */

const TYPES = { u8: Uint8Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array };

export class BlockError extends Error {
  constructor(block, problem) {
    super(`The report's block “${block}” ${problem}. The file is damaged or was cut short.`);
    this.name = 'BlockError';
    this.block = block;
  }
}

function bytesOfBase64(text) {
  if (typeof Uint8Array.fromBase64 === 'function') return Uint8Array.fromBase64(text);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; i++) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/** Exactly `size` bytes out of a zlib stream. */
async function inflate(bytes, size) {
  const stream = new DecompressionStream('deflate');
  const writer = stream.writable.getWriter();
  const written = writer.write(bytes).then(() => writer.close());
  written.catch(() => {}); // the reader reports the same failure
  const out = new Uint8Array(size);
  const reader = stream.readable.getReader();
  let filled = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (filled + value.length > size) throw new Error('too long');
    out.set(value, filled);
    filled += value.length;
  }
  await written;
  if (filled !== size) throw new Error('too short');
  return out;
}

/** Numbers are stored with the low byte first, which is not the order of every machine. */
function inOwnOrder(bytes, width) {
  if (width === 1 || new Uint8Array(new Uint16Array([1]).buffer)[0] === 1) return bytes;
  for (let i = 0; i < bytes.length; i += width) bytes.subarray(i, i + width).reverse();
  return bytes;
}

/**
 * @param {{name: string, type: string, count: number}} entry of the scene's list of arrays
 * @param {Document} page
 */
export async function readArray({ name, type, count }, page = document) {
  const element = page.getElementById(`cscd-array-${name}`);
  if (element === null) throw new BlockError(name, 'is missing');
  const Type = TYPES[type];
  if (Type === undefined) throw new BlockError(name, `has the unknown type ${type}`);
  try {
    const packed = bytesOfBase64(element.textContent.trim());
    const bytes = await inflate(packed, count * Type.BYTES_PER_ELEMENT);
    return new Type(inOwnOrder(bytes, Type.BYTES_PER_ELEMENT).buffer);
  } catch (error) {
    throw new BlockError(name, `cannot be read (${error.message || error.name})`);
  }
}

export function readDocument(page = document) {
  const element = page.getElementById('cscd-report');
  if (element === null) {
    throw new Error('This page holds no report: it is the empty template that “cscd” fills.');
  }
  let value;
  try {
    value = JSON.parse(element.textContent);
  } catch (error) {
    throw new BlockError('cscd-report', `cannot be read (${error.message})`);
  }
  if (value.format !== 1) {
    throw new Error(`This page reads reports of format 1; the data have format ${value.format}.`);
  }
  return value;
}
