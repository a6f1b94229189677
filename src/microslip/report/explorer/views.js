// Selection of a sweep and a Poisson's ratio: buttons for the sweeps of the paper, a list for others.

// Sweeps in the order of the page, each with its maps or lines by ascending Poisson's ratio.
function sweepsOf(numbers) {
  const found = new Map();
  for (const [kind, entries] of [["map", numbers.maps], ["lines", numbers.lines]]) {
    for (const entry of entries) {
      if (!found.has(entry.name)) found.set(entry.name, { ...entry, kind, entries: [] });
      found.get(entry.name).entries.push(entry);
    }
  }
  for (const one of found.values()) one.entries.sort((a, b) => a.poisson - b.poisson);
  return [...found.values()];
}

const SWEEPS = sweepsOf(NUMBERS);

function sweepOf(entry) {
  return SWEEPS.find((one) => one.name === entry.name);
}

function optionOf(value, text) {
  const option = document.createElement("option");
  Object.assign(option, { value, textContent: text });
  return option;
}

// Adds a button for each sweep without a group, and a list of the others by group.
function offerSweeps(choose) {
  for (const one of SWEEPS.filter((given) => given.group === null)) {
    const button = document.createElement("button");
    Object.assign(button, { type: "button", textContent: one.title });
    button.dataset.map = one.name;
    button.addEventListener("click", () => choose(one.entries[0]));
    element("tabs").append(button);
  }
  const others = SWEEPS.filter((given) => given.group !== null);
  element("others").hidden = others.length === 0;
  element("others").append(optionOf("", "other sweeps"));
  for (const group of new Set(others.map((one) => one.group))) {
    const part = document.createElement("optgroup");
    part.label = group.replaceAll("_", " ");
    part.append(...others.filter((one) => one.group === group).map((one) => optionOf(one.name, one.title)));
    element("others").append(part);
  }
  element("others").addEventListener("change", (e) => {
    const one = SWEEPS.find((given) => given.name === e.target.value);
    if (one) choose(one.entries[0]);
  });
  element("poisson").addEventListener("change", (e) => {
    choose(sweepOf(STATE.shown).entries[Number(e.target.value)]);
  });
}

// Marks the selected sweep and Poisson's ratio.
function markSweep(entry) {
  const { entries, group } = sweepOf(entry);
  for (const button of element("tabs").children) {
    button.setAttribute("aria-pressed", String(button.dataset.map === entry.name));
  }
  element("others").value = group === null ? "" : entry.name;
  element("poisson").replaceChildren(
    ...entries.map((one, k) => optionOf(String(k), `Poisson's ratio ${digits(one.poisson)}`)));
  element("poisson").value = String(entries.indexOf(entry));
  element("poisson").hidden = entries.length < 2;
}
