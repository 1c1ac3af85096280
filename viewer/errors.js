// Errors as a client sees them: it gets PostgreSQL's message about its arguments, and nothing about the
// server.
import pg from "pg";

export class Refused extends Error {
    constructor(status, message, hint) {
        super(message);
        Object.assign(this, { status, hint });
    }
}

/** The connection is gone, or none can be had. */
export class Away extends Refused {
    constructor(cause) {
        super(503, "the database cannot be reached");
        this.cause = cause;
    }
}

// With these PostgreSQL ends a connection: connections (08), an end of the server or of the session by
// hand (57P), a transaction that was idle (25P03) or open (25P04) for too long.
const endings = /^(08|57P|25P0[34])/;

/** What a statement returns. An error is PostgreSQL's, or Away. */
export async function ask(client, text, values) {
    try {
        return await client.query(text, values);
    } catch (error) {
        throw error instanceof pg.DatabaseError && !endings.test(error.code) ? error : new Away(error);
    }
}

/** The Refused that a client gets for an error. */
export function explain(error) {
    if (error instanceof Away) console.error(`viewer: ${error.message}: ${error.cause.message}`);
    if (error instanceof Refused) return error;
    if (!(error instanceof pg.DatabaseError)) {
        console.error(error); // a fault of the viewer, so with its stack
        return new Refused(500, "internal error in the viewer");
    }
    const { code = "", message, hint } = error;
    if (code === "42501") return new Refused(403, message);
    if (code === "23505") return new Refused(409, message);
    if (code === "57014") return new Refused(504, "the query took too long");
    if (code === "55P03") return new Refused(423, "another transaction has locked the mesh", "Try again after it has ended.");
    if (/^(22|42|54|55|40|25)/.test(code)) return new Refused(400, message, hint);
    console.error(`viewer: ${code} ${message}`);
    return code.startsWith("53") ? new Refused(503, "the database is out of resources") : new Refused(500, "the database could not answer");
}
