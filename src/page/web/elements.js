// Elements of the page. All text of the report goes through textContent, never through HTML.

const byId = id => document.getElementById(id);

/** An element with properties and children, which are elements or text. */
function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties))
    if (name.startsWith("aria-") || name === "role") made.setAttribute(name, value);
    else if (name === "style") made.style.cssText = value;
    else made[name] = value;
  made.append(...children.filter(child => child !== null && child !== undefined));
  return made;
}

function card(title, ...children) {
  return element("section", { className: "card" }, element("h2", {}, title), ...children);
}

/** Pairs of a term and what it is; those without a value are left out. */
function facts(pairs) {
  const list = element("dl");
  for (const [term, value] of pairs)
    if (value !== null && value !== undefined && value !== "")
      list.append(element("dt", {}, term), element("dd", {}, value));
  return list;
}

/** A number with about three digits: 0.000561, 12.3, 398 584. */
function shown(value) {
  if (typeof value !== "number" || !isFinite(value)) return "";
  const size = Math.abs(value);
  if (size >= 1000) return Math.round(value).toLocaleString("en").replaceAll(",", "\u2009");
  return String(Number(value.toPrecision(3)));
}

const percent = share => typeof share === "number" ? (100 * share).toFixed(share < 0.0995 ? 1 : 0) + " %" : "";

function duration(seconds) {
  if (seconds < 120) return seconds.toFixed(seconds < 10 ? 2 : 1) + " s";
  return Math.floor(seconds / 60) + " min " + Math.round(seconds % 60) + " s";
}

const mebibytes = bytes => shown(bytes / 1048576) + " MiB";
