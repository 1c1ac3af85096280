// Sessions of pages that edit. A session is a token, and as such costs nothing. From its first change
// until it saves or undoes it has a connection with one transaction, which holds the lock on the mesh:
// so there is one such session at most, and the others are refused meanwhile. What is not saved ends
// with its page, or with its connection; then each request of that page gets an error that says so.
import { randomBytes } from "node:crypto";
import { ask, Away, Refused } from "./errors.js";

const mostSessions = 256, mostOfClient = 16;
const outcomeWait = 10_000; // ms that a server may take to start again

const span = (ms) => (ms < 120_000 ? `${ms / 1000} seconds` : `${Math.round(ms / 60_000)} minutes`);
const counted = (changes) => (changes === 1 ? "1 change" : `${changes} changes`);
const were = (changes) => (changes === 1 ? "was" : "were");
const unsaved = (changes) => `${changes} unsaved change${changes === 1 ? "" : "s"} ${were(changes)}`;

/** The answer to each further request of a session. */
const ended = (message, lost = 0) => Object.assign(new Refused(410, message), { changes: 0, lost });

export class Sessions {
    constructor(database, { idle, absent }) {
        Object.assign(this, { database, idle, absent, holder: null });
        this.all = new Map(); // by token, those that were used the longest ago first
    }

    begin(client) {
        const ofClient = [...this.all.values()].filter((one) => one.client === client);
        if (ofClient.length >= mostOfClient) this.forget(ofClient);
        if (this.all.size >= mostSessions) this.forget([...this.all.values()]);
        const session = new Session(this, client);
        this.all.set(session.token, session);
        return session.token;
    }

    /** One without changes: its page begins another when it needs one. */
    forget(sessions) {
        const oldest = sessions.find((one) => one !== this.holder && one.waiting === 0);
        if (!oldest) throw new Refused(503, "too many pages are editing", "Try again in a minute.");
        this.all.delete(oldest.token);
    }

    get(token) {
        const session = this.all.get(token);
        if (!session) throw ended("this session has ended; any unsaved changes were undone");
        this.all.delete(token);
        this.all.set(token, session);
        if (session.ended) throw session.ended;
        session.seen = Date.now();
        return session;
    }

    async end() {
        for (const session of this.all.values()) await session.release(false);
    }
}

class Session {
    constructor(sessions, client) {
        const now = Date.now();
        // seen: when the page reported last; used: when it asked something, which it does not do by itself
        Object.assign(this, { sessions, client, database: sessions.database, token: randomBytes(24).toString("base64url"),
            edit: null, changes: 0, waiting: 0, seen: now, used: now, ended: null, last: Promise.resolve() });
    }

    /** One after the other. */
    queue(task) {
        ++this.waiting;
        const result = this.last.then(() => {
            if (this.ended) throw this.ended;
            return task();
        }).catch((error) => {
            if (error instanceof Away && this.edit) this.broken(error);
            throw this.ended ?? error;
        }).finally(() => {
            --this.waiting;
            this.seen = this.used = Date.now();
        });
        this.last = result.catch(() => {});
        return result;
    }

    /** Runs task(query), all of it or nothing, in the session's transaction; how many changes there are. */
    change(task) {
        return this.queue(async () => {
            this.claim();
            try {
                await this.open();
                const { edit } = this;
                await this.step(() => task(this.database.query(edit.client)));
                edit.xid ??= (await ask(edit.client, "SELECT pg_current_xact_id()::text AS xid")).rows[0].xid;
                return ++this.changes;
            } finally {
                if (this.changes === 0) await this.release();
            }
        });
    }

    claim() {
        const { holder, idle } = this.sessions;
        if (holder && holder !== this)
            throw new Refused(423, "another page has unsaved changes",
                `Save or undo them there. They are undone when nobody uses that page for ${span(idle)}.`);
        this.sessions.holder = this;
    }

    async open() {
        if (this.edit) return;
        const edit = { isSaving: false, xid: null };
        edit.client = await this.database.connectWriter((error) => {
            if (this.edit === edit && !edit.isSaving) this.broken(new Away(error));
        });
        this.edit = edit;
        await ask(edit.client, "BEGIN ISOLATION LEVEL READ COMMITTED READ WRITE");
        this.watch();
    }

    /** Ends what is not saved when the page is gone, or nobody is at it. */
    watch() {
        const { idle, absent } = this.sessions;
        const left = () => Math.min(this.used + idle, this.seen + absent) - Date.now();
        this.timer = setTimeout(() => {
            if (this.waiting > 0 || left() > 0) return this.watch();
            const why = this.used + idle <= Date.now() ? `nobody used the page for ${span(idle)}` : `the page did not report for ${span(absent)}`;
            this.over(`${why}; ${unsaved(this.changes)} undone`);
        }, Math.max(left(), 10));
        this.timer.unref();
    }

    /** What fails undoes itself, not what was before. */
    async guarded(task) {
        const result = await this.step(task);
        await ask(this.edit.client, "RELEASE SAVEPOINT viewer");
        return result;
    }

    /** The same, but what succeeds can be undone later: its savepoint stays, below those of the next steps. */
    async step(task) {
        await ask(this.edit.client, "SAVEPOINT viewer");
        try {
            return await task();
        } catch (error) {
            if (!(error instanceof Away)) await this.rollBack();
            throw error;
        }
    }

    /** Undoes all since the last savepoint, and forgets that one. What cannot be undone alone ends all. */
    rollBack() {
        return ask(this.edit.client, "ROLLBACK TO SAVEPOINT viewer; RELEASE SAVEPOINT viewer").catch((cause) => { throw new Away(cause); });
    }

    read(task, signal) {
        return this.queue(() => (this.edit ? this.guarded(() => task(this.database.query(this.edit.client, signal))) : this.database.readSaved(task, signal)));
    }

    /** How many changes are saved. */
    save() {
        return this.queue(async () => {
            const { changes, edit } = this;
            if (!edit) return 0;
            edit.isSaving = true;
            try {
                const { command } = await ask(edit.client, "COMMIT");
                if (command !== "COMMIT") throw new Refused(409, "the database did not save the changes");
            } catch (error) {
                if (!(error instanceof Away)) throw Object.assign(error, { lost: changes });
                await this.settle(edit, error);
            } finally {
                await this.release(false);
            }
            return changes;
        });
    }

    /** The connection broke before the answer: PostgreSQL knows whether the transaction is there. */
    async settle(edit, error) {
        const outcome = await this.outcome(edit.xid);
        if (outcome === "committed") return;
        if (outcome === "aborted") this.broken(error);
        else this.over(`the connection to the database broke during the save; it is not known whether ${counted(this.changes)} ${were(this.changes)} saved`, { isOpen: false, lost: null });
        throw this.ended;
    }

    async outcome(xid) {
        for (const until = Date.now() + outcomeWait; Date.now() < until;) {
            try {
                const [{ status }] = await this.database.rows(null, "SELECT pg_xact_status($1::text::xid8) AS status", [xid]);
                if (status !== "in progress") return status;
            } catch (error) {
                if (!(error instanceof Refused)) return null;
            }
            await new Promise((resolve) => setTimeout(resolve, 250));
        }
        return null;
    }

    /** How many changes are undone. */
    undo() {
        return this.queue(async () => {
            const { changes } = this;
            await this.release();
            return changes;
        });
    }

    /** Undoes the last change; how many there still are. */
    back() {
        return this.queue(async () => {
            if (this.changes === 0) return 0;
            await this.rollBack();
            if (--this.changes === 0) await this.release();
            return this.changes;
        });
    }

    /** The page goes. */
    close() {
        return this.queue(async () => {
            this.sessions.all.delete(this.token);
            await this.over("this session has ended; any unsaved changes were undone");
        });
    }

    broken({ cause }) {
        console.error(`viewer: an editing connection was lost: ${cause.message}`);
        return this.changes === 0 ? this.release(false) : this.over(`the connection to the database broke; ${unsaved(this.changes)} lost`, { isOpen: false });
    }

    over(message, { isOpen = true, lost = this.changes } = {}) {
        this.ended = ended(message, lost);
        return this.release(isOpen);
    }

    /** Gives the mesh free, and rolls back a transaction that is open. */
    async release(isOpen = true) {
        const { edit, sessions } = this;
        clearTimeout(this.timer);
        this.edit = null;
        this.changes = 0;
        if (edit && isOpen) await ask(edit.client, "ROLLBACK").catch(() => {});
        edit?.client.end().catch(() => {});
        if (sessions.holder === this) sessions.holder = null;
    }
}
