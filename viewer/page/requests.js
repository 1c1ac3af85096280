// What the page asks the server, and its session, if it edits.
import { undone } from "./common.js";

/** The folder of the page: that of its mesh, if the server shows several. */
export const root = location.pathname.replace(/[^/]*$/, "");

/** The token of the session, and how many changes are not saved. `heard` gets what an error says of them. */
export const editor = { session: null, unsaved: 0, heard: () => {} };

const named = () => (editor.session ? { "X-Session": editor.session } : {});
/** Without changes the page sees what is saved, for which it needs no session. */
export const sessionHeaders = () => (editor.unsaved > 0 ? named() : {});

/** Parts of a message as sentences. */
const sentences = (...parts) => parts.filter(Boolean).map((part) => part.replace(/\.?$/, ".")).join(" ");

export async function request(path, options) {
    const { session } = editor;
    const response = await fetch(path, options).catch(() => { throw new Error("The viewer's server cannot be reached."); });
    const answer = await response.json().catch(() => ({ error: `the server answered ${response.status} ${response.statusText}` }));
    if (response.ok) return answer;
    const { error, hint, changes, lost } = answer, hasEnded = response.status === 410, had = editor.unsaved;
    const message = sentences(error, hint, lost && !hasEnded && undone(lost));
    if (hasEnded && session === editor.session) editor.session = null;
    if (changes !== undefined) editor.heard(changes, lost ?? 0, message);
    throw Object.assign(new Error(message), { hasEnded, had });
}

export const ask = (name, parameters = {}) => request(`${root}api/${name}?${new URLSearchParams(parameters)}`, { headers: sessionHeaders() });
export const post = (name, body = {}) =>
    request(`${root}edit/${name}`, { method: "POST", headers: { "Content-Type": "application/json", ...named() }, body: JSON.stringify(body) });

/** What the server gets when the page goes, and no answer can come. */
export function leave() {
    const { session } = editor;
    if (session) navigator.sendBeacon(`${root}edit/end`, new Blob([JSON.stringify({ session })], { type: "application/json" }));
    editor.session = null;
}
