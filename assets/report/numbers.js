// Numbers as a person reads them: a few digits, powers of ten with superscripts, SI prefixes on axes.

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const PREFIXES = { "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T" };
// units that take a prefix before their first letter
const SCALABLE = ["J", "m", "s", "Hz", "N", "N m", "N s", "N m s", "W", "rad", "rad/s", "m/s"];

export function superscript(power) {
  const digits = String(Math.abs(power)).split("").map((digit) => SUPERSCRIPTS[Number(digit)]).join("");
  return (power < 0 ? "⁻" : "") + digits;
}

// A number with true minus signs, as the texts of the page have it.
const signed = (text) => text.replace("-", "\u2212");
const trimmed = (text) => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);

// A number with `digits` significant digits and without zeros at its end, by the rules of `findings::number`: a power of ten below 1e-3 and
// from the power on that has two digits more, smaller whole numbers in full.
export function readable(value, digits = 5) {
  if (!Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  if (size === 0) return "0";
  const [mantissa, power] = value.toExponential(digits - 1).split("e");
  if (size < 1e-3 || size >= Math.max(1e5, 10 ** (digits + 1))) return `${signed(trimmed(mantissa))}\u202f×\u202f10${superscript(Number(power))}`;
  return signed(trimmed(value.toFixed(Number.isInteger(value) ? 0 : Math.max(0, digits - 1 - Number(power)))));
}

// A unit whose powers are raised.
export function raised(unit) {
  return unit.replace("^2", "²").replace("^3", "³");
}

export function withUnit(value, unit) {
  return unit ? `${readable(value)} ${raised(unit)}` : readable(value);
}

// How the ticks of a linear axis are written: the factor between values and ticks, and what that makes of the unit.
export function tickScale(low, high, unit) {
  const size = Math.max(Math.abs(low), Math.abs(high));
  const isScalable = SCALABLE.includes(unit);
  // without a prefix a tick has one digit before its point
  const every = isScalable ? 3 : 1;
  let power = size > 0 ? every * Math.floor(Math.log10(size) / every + 1e-9) : 0;
  if (size >= 0.01 && size < 1e4) power = 0;
  const hasPrefix = isScalable && power in PREFIXES;
  const scaled = hasPrefix ? PREFIXES[power] + unit : [power === 0 ? "" : `10${superscript(power)}`, unit].filter(Boolean).join(" ");
  return { factor: 10 ** power, unit: scaled };
}

// The text of a tick; neighbouring ticks are `step` apart.
export function tickText(value, step, factor) {
  const decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(Math.abs(step / factor)) + 1e-9)));
  const text = (value / factor).toFixed(decimals);
  return Number(text) === 0 ? "0" : signed(trimmed(text));
}
