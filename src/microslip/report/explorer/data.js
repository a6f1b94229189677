// Decodes the numbers of the page, and expands a period to the whole disc.

const NUMBERS = JSON.parse(document.getElementById("numbers").textContent);

// Decodes base64 to typed arrays, little-endian.
function bytesOf(text) {
  return Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
}

// Returns the stored period of a point: forces divided by mu F_z and phases in rad at every frame,
// radii divided by a and bounds divided by mu F_z/a^2 for each ring, and the density of the
// dissipated energy in arbitrary units for each cell. If there is no period, returns null;
// `whyNone` returns the reason.
function periodAt(map, row, column) {
  const stored = map.periods?.[row][column];
  if (!stored?.tractions) return null;
  const numbers = (name, Type) => new Type(bytesOf(stored[name]).buffer);
  return {
    map,
    ...stored,
    frames: stored.phase.length - 1,
    cells: stored.radius.length,
    tractions: numbers("tractions", Int8Array),
    slips: bytesOf(stored.slips),
    densities: [...numbers("densities", Uint16Array)],
  };
}

function whyNone(map, row, column) {
  if (map.periods === null) return "The page has no periods of this map.";
  const failed = map.periods[row][column];
  if (failed) return `No period was found: ${failed.reason}`;
  if (map.amplitude[row] === 0) return "Nothing oscillates here: the whole contact slides at all times.";
  if (map.velocity[column] === 0) return "The static limit: no period belongs to it.";
  return "No period is stored for this point: the page has one for some points of each axis only.";
}

// Returns the angles of the sectors from the lateral axis, first for the stored half of the disc.
function sectorAngles({ angles, turned }) {
  const kept = Array.from({ length: angles }, (_, j) => ((j + 0.5) * Math.PI) / angles);
  return kept.concat(kept.map((angle) => (turned ? angle + Math.PI : -angle)));
}

// Returns the tractions divided by the bound, and the slip, of all cells in a frame, by sector and
// ring.
function cellsOf(period, frame) {
  const { frames, angles, cells, turned, tractions, slips } = period;
  const half = frames / 2;
  const at = frame % frames;
  const mirrored = at >= half; // half a period later, right and left are swapped
  const kept = mirrored ? at - half : at;
  const plane = angles * cells;
  const base = kept * 2 * plane;
  const found = { forward: [], lateral: [], slips: [] };
  for (const other of [false, true]) {
    for (let j = 0; j < angles; j++) {
      const source = (mirrored ? angles - 1 - j : j) * cells;
      const sign = (mirrored ? -1 : 1) * (other && !turned ? -1 : 1);
      for (let i = 0; i < cells; i++) {
        const bit = kept * plane + source + i;
        found.forward.push(tractions[base + source + i] / NUMBERS.shares);
        found.lateral.push((sign * tractions[base + plane + source + i]) / NUMBERS.shares);
        found.slips.push(((slips[bit >> 3] >> (7 - (bit & 7))) & 1) === 1);
      }
    }
  }
  return found;
}

// Formats a number with `count` digits, and a small number like 1.2e-4.
function digits(value, count = 4) {
  if (value === null) return "none";
  if (value !== 0 && Math.abs(value) < 1e-3) return value.toExponential(Math.min(count - 1, 2));
  return String(Number(value.toPrecision(count)));
}
