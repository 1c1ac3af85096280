// Changes of the mesh: what is not saved, and what becomes of it.
import { answering, counted, element, say, undone } from "./common.js";
import { editor, leave, post } from "./requests.js";

let beat, timer; // of the page's reports that it is there; in milliseconds
let redraw = async () => {};
/** What has been changed and not saved, the last at the end: { name, place, words }. */
const steps = [];
let marked = () => {};

function show(changes) {
    editor.unsaved = changes;
    steps.length = Math.min(steps.length, changes);
    marked(steps);
    element("save").disabled = element("undo").disabled = element("back").disabled = changes === 0;
    element("changes").textContent = changes === 0 ? "No unsaved changes" : counted(changes, "unsaved change");
    clearInterval(timer);
    if (changes > 0) timer = setInterval(stillThere, beat); // the server undoes what a page leaves behind
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
    if (editor.unsaved > 0) await post("alive").catch(() => {}); // what matters is heard below; a server that is away may return
}

/** Sets the page up to edit; `changed` is called when the mesh may look different, and `mark` with all unsaved changes. */
export function setUpEditing(changed, mark) {
    [redraw, marked] = [changed, mark];
    document.body.classList.add("edit");
    element("id").value = String(Date.now());
    editor.heard = (changes, lost, message) => {
        const had = editor.unsaved;
        show(changes);
        if (lost === 0 && had <= changes) return;
        say(message, "error"); // here, since the first to hear it may be a request of which nobody expects an answer
        drawAgain();
    };
    const finish = (name, words) => answering(async () => {
        const { changes } = await post(name);
        show(0);
        say(words(changes));
        await changed();
    });
    element("save").addEventListener("click", () => finish("save", (n) => `${counted(n, "change")} saved.`));
    element("undo").addEventListener("click", () => finish("undo", (n) => `${counted(n, "change")} undone.`));
    const stepBack = () => answering(async () => {
        const last = steps.at(-1);
        const { changes } = await post("back");
        show(changes);
        await changed();
        say(last ? `Taken back: ${last.words}` : "The last change was taken back.");
    });
    element("back").addEventListener("click", stepBack);
    addEventListener("keydown", (event) => {
        if (event.key !== "z" || !(event.ctrlKey || event.metaKey) || event.shiftKey || event.target.matches?.("input:not([type=radio]), textarea") || editor.unsaved === 0) return;
        event.preventDefault();
        stepBack();
    });
    addEventListener("beforeunload", (event) => { if (editor.unsaved > 0) event.preventDefault(); });
    addEventListener("pagehide", leave);
    addEventListener("pageshow", ({ persisted }) => { // the browser has kept the page, the server not what it had changed
        if (!persisted || editor.unsaved === 0) return;
        say(`You left this page: ${undone(editor.unsaved)}.`, "error");
        show(0);
        drawAgain();
    });
}

async function attempt(name, body) {
    if (!editor.session) {
        const { session, beat: interval } = await post("begin");
        editor.session = session;
        beat = interval;
    }
    return post(name, body);
}

/** A change of the mesh, at a place, in words. */
export async function change(name, body, words) {
    const { changes } = await attempt(name, body).catch((error) => {
        if (!error.hasEnded || error.had > 0) throw error;
        return attempt(name, body); // the server forgets sessions that have changed nothing
    });
    steps.push({ name, at: body.at, to: body.to, words });
    show(changes);
    if (name === "insert") element("id").value = String(BigInt(element("id").value) + 1n);
}
