// What the page asks the server, and its session, if it edits.

let session = null; // its token; of a browser that edits
export const sessionHeaders = () => (session ? { "X-Session": session } : {});
export const setSession = (token) => { session = token; };
export const hasSession = () => session !== null;

let settle = () => {};
/** `heard(changes, lost)` is called when the server says in an error how many changes are open, and how many it has just undone. */
export const onChanges = (heard) => { settle = heard; };

/** Parts of a message as sentences. */
const sentences = (...parts) => parts.filter(Boolean).map((part) => part.replace(/\.?$/, ".")).join(" ");

async function request(path, options) {
    const asked = session;
    const response = await fetch(path, { ...options, headers: { ...sessionHeaders(), ...options?.headers } })
        .catch(() => { throw new Error("The viewer's server cannot be reached."); });
    const answer = await response.json().catch(() => ({ error: `the server answers ${response.status} ${response.statusText}` }));
    if (response.ok) return answer;
    const { error, hint, changes, lost } = answer, hasEnded = response.status === 410;
    if (hasEnded && asked === session) session = null;
    if (changes !== undefined) settle(changes, lost ?? 0);
    throw Object.assign(new Error(sentences(error, hint, lost && !hasEnded && `Changes that are undone: ${lost}`)), { status: response.status });
}

export const ask = (name, parameters = {}) => request(`/api/${name}?${new URLSearchParams(parameters)}`);
export const post = (name, body = {}) =>
    request(`/edit/${name}`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });

/** What the server gets when the page goes, and no answer can come. */
export function leave() {
    if (session) navigator.sendBeacon("/edit/end", new Blob([JSON.stringify({ session })], { type: "application/json" }));
    session = null;
}
