// Pages and links of a large mesh checked by several threads.
//
//   pages     The session's thread reads them. Whichever thread has nothing to do gets the next few
//             (page_feed.hpp).
//   topology  The curve is cut in parts of as many pages. For each a thread follows all links from
//             its pages, in a cache of its own, which also loads what lies across the border. What
//             the stars of vertices tell is added up.
//
// Threads only find out that there is no fault, which most meshes have not. As soon as one
// has found any, all end, and the session's thread does the pass again: so which faults are listed,
// and in which order, does not depend on the number of threads, nor on what their caches held.
// Nor does a fault escape them: all that is looked at is looked at by some thread.
#pragma once

#include "host/crew.hpp"
#include "query/check/check.hpp"
#include "query/pages/page_feed.hpp"

namespace abacus {

template <int D> class Check<D>::Together {
public:
    explicit Together(Check &check);

    static bool is_worth_while(const Host &host, const abacus_facts &facts);

    /// The passes; false if a fault was found, or the system grants no thread: then nothing is
    /// known.
    bool check_pages();
    bool check_topology();

private:
    class Pass;
    class Pages;
    class Topology;

    Check &check_;
    Crew crew_;
    PageFeed feed_;
};

} // namespace abacus
