// Writes dist/hashes.txt: the hash of all that the bundle is made of, and that of the bundle. By it a test tells whether one was changed without the other.

import { readdirSync, readFileSync, writeFileSync } from "node:fs";

/// FNV-1a with 64 bits, in hexadecimal digits.
function hash(parts) {
  let value = 0xcbf29ce484222325n;
  for (const byte of Buffer.concat(parts)) value = BigInt.asUintN(64, (value ^ BigInt(byte)) * 0x100000001b3n);
  return value.toString(16).padStart(16, "0");
}

const sources = ["THREE-LICENSE", "package-lock.json", "package.json", ...readdirSync("src").sort().map((name) => `src/${name}`)];
const named = sources.flatMap((name) => [Buffer.from(`${name}\n`), readFileSync(name)]);
writeFileSync("dist/hashes.txt", `sources ${hash(named)}\nlive.js ${hash([readFileSync("dist/live.js")])}\n`);
