// What is embedded in the page: compressed bytes as text, inflated by the browser.

async function inflated(id) {
  const text = document.getElementById(id).textContent;
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function embeddedText(id) {
  return new TextDecoder().decode(await inflated(id));
}

// The data of the page; a place [offset, count, size] becomes the numbers that are there.
export async function embeddedData() {
  const [text, bytes] = await Promise.all([embeddedText("data"), inflated("numbers")]);
  const isPlace = (value) => Array.isArray(value) && value.length === 3 && value.every(Number.isInteger) && (value[2] === 8 || value[2] === 4);
  const kinds = { 8: Float64Array, 4: Float32Array };
  const arrays = ["x", "y", "low", "high", "edges", "heights", "counts", "values", "samples", "fates", "times", "attitude", "omega", "momentum", "angles", "phase", "firing", "relative", "nadir", "velocity", "sun", "field", "hidden"];
  const places = new Set(arrays);
  return JSON.parse(text, (key, value) => {
    if (!places.has(key) || !isPlace(value)) return value;
    const [offset, count, size] = value;
    return new kinds[size](bytes.buffer, bytes.byteOffset + offset, count);
  });
}

// Runs an embedded library and returns what it defines.
export async function library(name) {
  const script = document.createElement("script");
  script.textContent = `${await embeddedText(name)};globalThis.${name}=${name};`;
  document.head.append(script);
  return globalThis[name];
}
