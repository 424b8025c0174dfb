// The start page of sinew live: the scenes as cards, with their measured paces; one of them is chosen and opens at this address.

"use strict";

const get = (id) => document.getElementById(id);

/// Time (ms) between two looks at the state: while a scene opens, while paces are measured, and later.
const WHILE_OPENING = 150;
const WHILE_MEASURING = 400;
const LATER = 1500;

/// Time (ms) after which an opening scene is said to take long.
const LONG = 1500;

/// Number of looks in vain after which the page says that it has no connection.
const MANY = 4;

const cards = new Map();
/// The scene that opens: its title, and the time (ms) of its choice.
let opening = null;
let inVain = 0;

const element = (name, attributes = {}, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
};

function say(text) {
  get("message").textContent = text ?? "";
  get("message").hidden = !text;
}

/// A factor with two digits, rounded down so that nothing below real time looks like it.
function rounded(factor) {
  const exponent = Math.floor(Math.log10(Math.max(factor, 1e-9))) - 1;
  const digits = Math.max(0, -exponent);
  return (Math.floor(factor / 10 ** exponent) * 10 ** exponent).toFixed(digits);
}

/// The kind of a pace, and the pace in words.
function paceInWords({ pace, factor }) {
  if (pace === "waits") return ["waits", "pace: not measured yet"];
  if (pace === "runs") return ["runs", "pace: measuring …"];
  if (pace === "unknown") return ["unknown", "pace: cannot be measured"];
  if (factor >= 1) return ["real-time", `${rounded(factor)} × real time`];
  return ["slower", `${rounded(factor)} × real time: slower`];
}

function cardOf({ name, title, about, method, alt }) {
  const [aboutId, factsId] = [`${name}-about`, `${name}-facts`];
  const button = element("button", { type: "button", "aria-describedby": `${aboutId} ${factsId}` }, title);
  button.addEventListener("click", () => choose(name, title));
  const words = element("span");
  const pace = element("span", { class: "pace" }, element("i", { "aria-hidden": "true" }), words);
  const card = element("article", { class: "card", "data-scene": name },
    element("img", { src: `${name}.png`, alt, width: 320, height: 180 }),
    element("h3", {}, button),
    element("p", { id: aboutId }, about),
    element("div", { class: "facts", id: factsId }, pace, element("span", { class: "method" }, method)));
  cards.set(name, { card, pace, words });
  return element("li", {}, card);
}

/// Makes the cards, under their headings.
function build(offers) {
  let list = null;
  let heading = null;
  for (const offer of offers) {
    if (offer.group !== heading) {
      heading = offer.group;
      list = element("ul");
      const id = `group-${cards.size}`;
      get("scenes").append(element("section", { "aria-labelledby": id }, element("h2", { id }, heading), list));
    }
    list.append(cardOf(offer));
  }
}

function show({ offers, notice, version }) {
  if (cards.size === 0) build(offers);
  for (const offer of offers) {
    const { pace, words } = cards.get(offer.name);
    const [kind, text] = paceInWords(offer);
    pace.dataset.pace = kind;
    if (words.textContent !== text) words.textContent = text;
  }
  get("footer").textContent = `sinew ${version} · seen by this computer alone · Ctrl-C where \`sinew live\` runs ends it`;
  if (!opening) say(notice);
}

/// Marks a scene as the one that opens; `null` for none.
function mark(name) {
  get("scenes").setAttribute("aria-busy", String(name !== null));
  for (const [own, { card }] of cards) card.classList.toggle("opens", own === name);
}

function begin(name, title) {
  opening = { title, since: performance.now() };
  mark(name);
  sayOfOpening();
}

function sayOfOpening() {
  if (!opening) return;
  const taken = performance.now() - opening.since;
  const long = taken > LONG ? ` Building it takes long: ${Math.round(taken / 1000)} s so far.` : "";
  say(`Opening: ${opening.title} …${long}`);
}

async function choose(name, title) {
  if (opening) return;
  begin(name, title);
  try {
    const answer = await fetch("choose", { method: "POST", body: name });
    if (answer.ok) return;
    // Another page may have been first: then its scene opens here, too.
    if (answer.status !== 409) throw new Error(await answer.text());
  } catch (error) {
    opening = null;
    mark(null);
    say(`It could not be opened. ${error.message}`);
  }
}

/// Looks at the state once; returns the time (ms) until the next look.
async function look() {
  const answer = await fetch("state", { cache: "no-store" });
  const state = await answer.json();
  if (state.page !== "start") {
    window.location.reload();
    return LATER;
  }
  inVain = 0;
  if (state.chosen && !opening) begin(null, state.chosen);
  // A scene that was chosen a moment ago may be on its way to the server.
  if (!state.chosen && opening && performance.now() - opening.since > 1000) {
    opening = null;
    mark(null);
  }
  show(state);
  if (opening) return WHILE_OPENING;
  return state.offers.some(({ pace }) => pace === "waits" || pace === "runs") ? WHILE_MEASURING : LATER;
}

async function watch() {
  let wait = WHILE_MEASURING;
  try {
    wait = await look();
  } catch {
    inVain += 1;
    if (inVain >= MANY) {
      opening = null;
      mark(null);
      say("No connection: `sinew live` has ended. Its address changes with each start.");
    }
  }
  window.setTimeout(watch, wait);
}

window.setInterval(sayOfOpening, 500);
watch();
