// A tree: the numbers of its nodes, and what is derived from them. Node i, unless it is a root, is the distal end of
// segment i, a cylinder with round ends. Coordinates are in mm relative to `origin`.

const NONE = 0xffff; // in a field of 16-bit integers: no value

function text(id) {
  return document.getElementById(id).textContent;
}

// Decodes a block of base64 to numbers. They are little-endian, as are all machines that browsers run on.
function block(id, Numbers) {
  const chars = atob(text(id));
  const bytes = new Uint8Array(chars.length);
  for (let i = 0; i < chars.length; i++) bytes[i] = chars.charCodeAt(i);
  return new Numbers(bytes.buffer);
}

function readField(k, { whole }) {
  const packed = block("field-" + k, whole ? Uint16Array : Float32Array);
  return whole ? Float32Array.from(packed, (v) => (v === NONE ? NaN : v)) : packed;
}

// Reads the tree of a page that `corcast export` has written [src/page/blocks.c]. Returns what Tree takes.
export function readPage() {
  const properties = JSON.parse(text("properties"));
  return {
    properties,
    position: block("position", Float32Array), // x, y, z per node
    radius: block("radius", Float32Array), // per node
    parent: block("parent", Uint32Array), // index per node; a root has its own
    place: document.getElementById("place") && block("place", Uint32Array), // index per node, of a network with loops
    id: block("id", Uint32Array), // per node
    fields: properties.fields.map((field, k) => ({ ...field, values: readField(k, field) })), // NaN: no value
    maps: properties.maps.map((map, k) => ({ ...map, bytes: block("map-" + k, Uint8Array) })),
  };
}

class Field {
  constructor(properties, { n, segments }) {
    Object.assign(this, properties);
    const isShown = new Uint8Array(n);
    for (const i of segments) isShown[i] = 1;
    this.finite = this.values.filter((value, at) => isShown[at % n] && Number.isFinite(value)); // at all times
  }

  // The finite values of all segments at all times, ascending.
  get sorted() {
    this.ascending ||= this.finite.sort();
    return this.ascending;
  }
}

export class Tree {
  constructor(source) {
    Object.assign(this, source);
    this.n = this.radius.length;
    this.findSegments();
    this.measure();
    this.fields = source.fields.map((properties) => new Field(properties, this)).filter((field) => field.finite.length > 0);
  }

  // Finds the segments that have a length and a radius, the index of each by its id, and the daughters of each node. A
  // segment that closes a loop continues in the segments that meet at the point where it ends.
  findSegments() {
    const { n, parent, place, radius } = this;
    this.segments = [];
    this.numberOf = new Map();
    this.daughters = Array.from({ length: n }, () => []);
    for (let i = 0; i < n; i++) {
      if (parent[i] !== i) this.daughters[parent[i]].push(i);
      if (parent[i] === i || !(radius[i] > 0) || !(this.length(i) > 0)) continue;
      this.segments.push(i);
      this.numberOf.set(this.id[i], i);
    }
    place?.forEach((node, i) => { if (node !== i) this.daughters[i] = [node, ...this.daughters[node]].filter((k) => k !== i); });
  }

  // Finds the box of the segments, and the path length along the vessels from the root to each node, mm.
  measure() {
    const { n, parent, position, radius } = this;
    this.low = [Infinity, Infinity, Infinity];
    this.high = [-Infinity, -Infinity, -Infinity];
    for (const i of this.segments)
      for (const node of [i, parent[i]])
        for (let c = 0; c < 3; c++) {
          this.low[c] = Math.min(this.low[c], position[3 * node + c] - radius[i]);
          this.high[c] = Math.max(this.high[c], position[3 * node + c] + radius[i]);
        }
    this.half = Math.hypot(...this.high.map((h, c) => Math.max(Math.abs(h), Math.abs(this.low[c])))); // of a ball around it
    this.pathLength = new Float32Array(n);
    this.longest = 0;
    for (let i = 0; i < n; i++) {
      if (parent[i] !== i) this.pathLength[i] = this.pathLength[parent[i]] + this.length(i);
      if (this.pathLength[i] > this.longest) this.longest = this.pathLength[i];
    }
  }

  // Returns the coordinates of node i, and of the middle of segment i.
  point(i) { return this.position.subarray(3 * i, 3 * i + 3); }
  middle(i) { return Array.from(this.point(i), (v, c) => (v + this.point(this.parent[i])[c]) / 2); }

  length(i) {
    const a = 3 * this.parent[i], b = 3 * i, p = this.position;
    return Math.hypot(p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]);
  }

  // Returns the index of the first segment that a ray hits, or -1. Only segments that begin within the fraction `grown`
  // of the longest path count. To make thin vessels easy to hit, a vessel's radius counts as at least `least` mm, plus
  // `slack` mm per mm of distance from the ray's start.
  pick(from, along, slack, least, grown) {
    const { parent, position, radius } = this;
    let best = -1, nearest = Infinity;
    for (const i of this.segments) {
      if (this.pathLength[parent[i]] > grown * this.longest) continue;
      const a = 3 * parent[i], b = 3 * i;
      const x = position[b] - position[a], y = position[b + 1] - position[a + 1], z = position[b + 2] - position[a + 2];
      const px = position[a] - from.x, py = position[a + 1] - from.y, pz = position[a + 2] - from.z;
      const ee = x * x + y * y + z * z, ed = x * along.x + y * along.y + z * along.z;
      const pe = px * x + py * y + pz * z, pd = px * along.x + py * along.y + pz * along.z;
      const s = Math.min(1, Math.max(0, (pd * ed - pe) / Math.max(ee - ed * ed, 1e-12)));
      const t = pd + s * ed;
      if (t <= 0) continue;
      const dx = px + s * x - t * along.x, dy = py + s * y - t * along.y, dz = pz + s * z - t * along.z;
      const apart = dx * dx + dy * dy + dz * dz;
      const reach = Math.max(radius[i], least + slack * t);
      if (apart > reach * reach) continue;
      const depth = t - Math.sqrt(reach * reach - apart);
      if (depth < nearest) {
        nearest = depth;
        best = i;
      }
    }
    return best;
  }
}
