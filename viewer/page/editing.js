// Changes of the mesh: what is not saved, and what becomes of it.
import { answering, element, say } from "./common.js";
import { hasSession, leave, onChanges, post, setSession } from "./requests.js";

let unsaved = 0, beat = 20_000, timer;
let redraw = async () => {};

function show(changes) {
    unsaved = changes;
    element("save").disabled = element("undo").disabled = changes === 0;
    element("changes").textContent = changes === 0 ? "no changes" : `${changes} not saved`;
    clearInterval(timer);
    if (changes > 0) timer = setInterval(() => stillThere(), beat); // the server undoes what a page leaves behind
}

/** Draws the mesh as it is, as soon as the database can be asked. */
async function drawAgain() {
    for (;;) {
        try {
            return await redraw();
        } catch {
            await new Promise((resolve) => setTimeout(resolve, 2000));
        }
    }
}

/** Tells the server that the page is there, and hears whether its changes are. */
export async function stillThere() {
    if (!hasSession()) return;
    try {
        await post("alive");
    } catch (error) {
        if (error.status === 410) say(error.message, "error");
    }
}

/** Sets the page up to edit; `changed` is called when the mesh may look different. */
export function setUpEditing(changed) {
    redraw = changed;
    document.body.classList.add("edit");
    element("id").value = String(Date.now());
    onChanges((changes, lost) => {
        const had = unsaved;
        show(changes);
        if (lost > 0 || had > changes) drawAgain();
    });
    const finish = (name, words) => answering(async () => {
        const { changes } = await post(name);
        show(0);
        say(words(changes));
        await changed();
    });
    element("save").addEventListener("click", () => finish("save", (n) => `Saved: ${n} changes.`));
    element("undo").addEventListener("click", () => finish("undo", (n) => `Undone: ${n} changes.`));
    addEventListener("beforeunload", (event) => { if (unsaved > 0) event.preventDefault(); });
    addEventListener("pagehide", leave);
    addEventListener("pageshow", ({ persisted }) => { // the browser has kept the page, the server not what it had changed
        if (!persisted || unsaved === 0) return;
        say(`You have left this page. Changes that are undone: ${unsaved}.`, "error");
        show(0);
        drawAgain();
    });
}

/** A change of the mesh. */
export async function change(name, body) {
    const had = unsaved;
    const attempt = async () => {
        if (!hasSession()) {
            const begun = await post("begin");
            setSession(begun.session);
            beat = begun.beat;
        }
        return post(name, body);
    };
    const { changes } = await attempt().catch((error) => {
        if (error.status !== 410 || had > 0) throw error;
        return attempt(); // the server forgets sessions that have changed nothing
    });
    show(changes);
    if (name === "insert") element("id").value = String(BigInt(element("id").value) + 1n);
}
