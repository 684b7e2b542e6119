/** Which triangles share each vertex and each edge. */

/** Triangles around each vertex, as compressed rows. */
export function trianglesOfVertices({ triangles, vertexCount }) {
  const begin = new Uint32Array(vertexCount + 1);
  for (const vertex of triangles) begin[vertex + 1]++;
  for (let v = 0; v < vertexCount; v++) begin[v + 1] += begin[v];
  const next = begin.slice(0, vertexCount);
  const items = new Uint32Array(triangles.length);
  for (let c = 0; c < triangles.length; c++) items[next[triangles[c]]++] = Math.floor(c / 3);
  return { begin, items };
}

export const around = ({ begin, items }, vertex) => items.subarray(begin[vertex], begin[vertex + 1]);

function withVertices(incidence, triangles, vertices) {
  return [...around(incidence, vertices[0])].filter((t) => {
    const corners = [triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]];
    return vertices.every((vertex) => corners.includes(vertex));
  });
}

/** The triangles of a contact. VF: those around the vertex, and the face; EE: those at both edges. */
export function contactTriangles({ triangles, contacts }, incidence, contact) {
  const [a, b, c, d] = contacts.vertices.subarray(4 * contact, 4 * contact + 4);
  const of = (...vertices) => withVertices(incidence, triangles, vertices);
  return contacts.kind[contact] === 0 ? [...of(a), ...of(b, c, d)] : [...of(a, b), ...of(c, d)];
}

function edgesBetween({ triangles, triangleCount, vertexCount, region }, found) {
  const seen = new Map();
  for (let t = 0; t < triangleCount; t++) {
    for (let corner = 0; corner < 3; corner++) {
      const a = triangles[3 * t + ((corner + 1) % 3)];
      const b = triangles[3 * t + ((corner + 2) % 3)];
      const key = Math.min(a, b) * vertexCount + Math.max(a, b);
      const other = seen.get(key);
      if (other === undefined) seen.set(key, 3 * t + corner);
      else if (region[Math.floor(other / 3)] !== region[t]) found(3 * t + corner, other, a, b);
    }
  }
}

/**
 * For each triangle the bits of those edges whose other side is another region, `edgeBits[i]` for the one
 * opposite to corner i, and of those corners that such an edge of any triangle ends in.
 */
export function cutEdges(scene, edgeBits, cornerBits) {
  const flags = new Uint8Array(scene.triangleCount);
  const ends = new Uint8Array(scene.vertexCount);
  edgesBetween(scene, (one, other, a, b) => {
    for (const place of [one, other]) flags[Math.floor(place / 3)] |= edgeBits[place % 3];
    ends[a] = ends[b] = 1;
  });
  scene.triangles.forEach((vertex, place) => {
    if (ends[vertex] === 1) flags[Math.floor(place / 3)] |= cornerBits[place % 3];
  });
  return flags;
}
