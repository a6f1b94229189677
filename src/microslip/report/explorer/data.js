// Decodes the numbers of the page, and expands a period to the whole disc.

const NUMBERS = JSON.parse(document.getElementById("numbers").textContent);

// Base64 to typed arrays, little-endian.
function bytesOf(text) {
  return Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
}

// Returns the decoded periods of a map. The first call decodes them.
function decoded({ periods }) {
  const numbers = (name, Type) => new Type(bytesOf(periods[name]).buffer);
  periods.decoded ??= {
    tractions: numbers("tractions", Int8Array),
    slips: bytesOf(periods.slips),
    forces: numbers("forces", Int16Array),
    ...Object.fromEntries(["phases", "radii", "bounds", "densities"].map((name) => [name, numbers(name, Uint16Array)])),
  };
  return periods.decoded;
}

// The stored period of a point of a map: forces over mu F_z and phases in rad at every frame, radii
// over a and bounds over mu F_z/a^2 of the rings, and for each cell the density of the dissipated
// energy over the largest density. If there is no period, returns null, and `whyNone` has the reason.
function periodAt(map, row, column) {
  const p = map.periods;
  if (p.count === 0) return null;
  const k = p.index[row][column];
  if (k < 0) return null;
  const { forces, phases, radii, bounds, densities } = decoded(map);
  const rows = p.frames + 1;
  const part = (array, count, scale) =>
    Array.from(array.subarray(k * count, (k + 1) * count), (n) => n * scale);
  const pairs = part(forces, 2 * rows, p.force_step);
  return {
    map,
    k,
    phase: part(phases, rows, (2 * Math.PI) / NUMBERS.unsigned).map((phase) => p.start + phase),
    forward: pairs.slice(0, rows),
    other: pairs.slice(rows),
    radius: part(radii, p.cells, 1 / NUMBERS.unsigned),
    bound: part(bounds, p.cells, 1 / NUMBERS.unsigned),
    density: part(densities, p.angles * p.cells, 1 / NUMBERS.unsigned),
    mean: p.mean[k],
    converged: p.converged[k],
    reason: p.reason[k],
  };
}

function whyNone(map, row, column) {
  const failed = map.periods.failed.find(([i, j]) => i === row && j === column);
  if (failed) return `No period was found: ${failed[2]}`;
  if (map.periods.index === null) return "The page has no periods of this map.";
  if (map.amplitude[row] === 0) return "Nothing oscillates here: the whole contact slides at all times.";
  if (map.velocity[column] === 0) return "The static limit: no period belongs to it.";
  return "No period is stored for this point: the page has one for some points of each axis only.";
}

// Angles of the sectors from the lateral axis: the stored half of the disc, then the other half.
function sectorAngles(map) {
  const { angles, turned } = map.periods;
  const kept = Array.from({ length: angles }, (_, j) => ((j + 0.5) * Math.PI) / angles);
  return kept.concat(kept.map((angle) => (turned ? angle + Math.PI : -angle)));
}

// Cells of a frame, sector by sector and ring by ring: tractions over the bound, and slip.
function cellsOf(period, frame) {
  const { frames, angles, cells, turned } = period.map.periods;
  const { tractions, slips } = decoded(period.map);
  const half = frames / 2;
  const at = frame % frames;
  const mirrored = at >= half; // half a period later, right and left are swapped
  const kept = mirrored ? at - half : at;
  const plane = angles * cells;
  const base = (period.k * half + kept) * 2 * plane;
  const bits = period.k * Math.ceil((half * plane) / 8);
  const found = { forward: [], lateral: [], slips: [] };
  for (const other of [false, true]) {
    for (let j = 0; j < angles; j++) {
      const source = (mirrored ? angles - 1 - j : j) * cells;
      const sign = (mirrored ? -1 : 1) * (other && !turned ? -1 : 1);
      for (let i = 0; i < cells; i++) {
        const bit = kept * plane + source + i;
        found.forward.push(tractions[base + source + i] / NUMBERS.shares);
        found.lateral.push((sign * tractions[base + plane + source + i]) / NUMBERS.shares);
        found.slips.push(((slips[bits + (bit >> 3)] >> (7 - (bit & 7))) & 1) === 1);
      }
    }
  }
  return found;
}

// A number with `count` digits; small numbers like 1.2e-4.
function digits(value, count = 4) {
  if (value === null) return "none";
  if (value !== 0 && Math.abs(value) < 1e-3) return value.toExponential(Math.min(count - 1, 2));
  return String(Number(value.toPrecision(count)));
}
