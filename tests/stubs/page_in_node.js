// A document and a plotly that are just enough to run the page's scripts in node, and to look at
// what they made of it. Elements are those of page.html that have an id.

class Element {
  constructor(tag) {
    Object.assign(this, { tag, id: "", children: [], listeners: {}, attributes: {}, dataset: {}, style: {} });
    this.classList = { toggle() {} };
    Object.assign(this, { textContent: "", className: "", hidden: false, value: "", data: [] });
  }

  append(...parts) {
    this.children.push(...parts);
    for (const part of parts) if (part.id) ELEMENTS[part.id] = part;
  }

  replaceChildren(...parts) {
    this.children = [];
    this.append(...parts);
  }

  setAttribute(name, value) {
    this.attributes[name] = String(value);
  }

  addEventListener(name, heard) {
    (this.listeners[name] ??= []).push(heard);
  }

  on(name, heard) {
    if (!this.drawn) throw new Error(`nothing is drawn in ${this.id}, so plotly hears nothing there`);
    this.addEventListener(name, heard);
  }

  fire(name, event = {}) {
    for (const heard of this.listeners[name] ?? []) heard({ target: this, preventDefault() {}, ...event });
  }

  insertRow() {
    const row = new Element("tr");
    this.append(row);
    return row;
  }

  insertCell() {
    const cell = new Element("td");
    this.append(cell);
    return cell;
  }

  get text() {
    return [this.textContent, ...this.children.map((one) => (one instanceof Element ? one.text : one))]
      .filter(Boolean).join(" ");
  }
}

const ELEMENTS = {};
const document = {
  body: new Element("body"),
  getElementById(id) {
    if (!(id in ELEMENTS)) throw new Error(`the page has no element ${id}`);
    return ELEMENTS[id];
  },
  createElement: (tag) => new Element(tag),
  createElementNS: (_, tag) => new Element(tag),
};

// Which elements what is drawn must not be hidden in.
const PARENTS = {};
const Plotly = {
  react(element, data, layout) {
    const hidden = element.hidden || (PARENTS[element.id] ?? []).some((id) => ELEMENTS[id].hidden);
    if (hidden) throw new Error(`${element.id} is hidden: what is drawn there has no size`);
    for (const trace of data) if (trace === undefined) throw new Error(`${element.id}: no trace`);
    Object.assign(element, { data, layout, drawn: true });
  },
  restyle(element, change) {
    element.restyled = change;
  },
  relayout(element, change) {
    Object.assign(element.layout, change);
  },
};
const location = { hash: "" };
const history = { replaceState(_state, _title, address) { location.hash = address; } };
const addEventListener = () => {};
const matchMedia = () => ({ matches: false, addEventListener() {} });
const requestAnimationFrame = () => 1, cancelAnimationFrame = () => {};

const { ids, parents, numbers, steps } = JSON.parse(require("fs").readFileSync(0, "utf8"));
for (const [id, hidden] of Object.entries(ids)) {
  ELEMENTS[id] = Object.assign(new Element("div"), { id, hidden });
}
Object.assign(PARENTS, parents);
ELEMENTS.numbers.textContent = JSON.stringify(numbers);
