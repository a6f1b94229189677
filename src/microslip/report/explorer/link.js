// Stores the state of the page in the fragment of the address, so that a link restores the state.

const LINK_DELAY = 250; // ms; browsers refuse more than about 200 changes of the address in 30 s
let linkTimer = 0;

// Returns the address fragment for a state.
function linkOf(state) {
  const { shown, map } = state, said = new URLSearchParams();
  said.set("sweep", shown.name);
  said.set("poisson", String(shown.poisson));
  if (shown === map) {
    said.set("amplitude", String(map.amplitude[state.row]));
    said.set("velocity", String(map.velocity[state.column]));
    if (state.period) said.set("frame", String(state.frame));
  } else {
    said.set("at", String(shown.x.values[state.at]));
  }
  for (const label of state.hidden) said.append("without", label);
  if (state.asking) {
    said.set("contact", "open");
    for (const [name, text] of Object.entries(TEXTS)) said.set(`contact.${name}`, text);
  }
  return said.toString();
}

// Writes the state into the address after a delay without changes.
function writeLink() {
  if (!document.body.dataset.ready) return;
  clearTimeout(linkTimer);
  linkTimer = setTimeout(() => history.replaceState(null, "", `#${linkOf(STATE)}`), LINK_DELAY);
}

// Returns the index of the value with this text, or else the selected index.
function indexNamed(values, text, selected) {
  const index = values.findIndex((value) => String(value) === text);
  return index < 0 ? selected : index;
}

// Restores the state that an address contains. Missing and wrong entries are ignored.
function readLink(address) {
  const said = new URLSearchParams(address.replace(/^#/, ""));
  const entries = SWEEPS.find((one) => one.name === said.get("sweep"))?.entries;
  if (!entries) return;
  for (const [name, text] of said) {
    if (name.startsWith("contact.")) fillField(name.slice("contact.".length), text);
  }
  STATE.hidden = new Set(said.getAll("without"));
  STATE.asking = said.get("contact") === "open";
  show(entries.find((one) => String(one.poisson) === said.get("poisson")) ?? entries[0]);
  if (STATE.asking) answerForm();
  const { map, shown } = STATE;
  if (shown === map) {
    const frame = Number(said.get("frame"));
    if (frame >= 0) STATE.frame = Math.floor(frame); // limited to the last frame when drawn
    selectAndMark(indexNamed(map.amplitude, said.get("amplitude"), STATE.row),
      indexNamed(map.velocity, said.get("velocity"), STATE.column));
  } else {
    selectOnLine(indexNamed(shown.x.values, said.get("at"), STATE.at));
  }
}
