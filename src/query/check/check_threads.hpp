// Checks the pages and links of a large mesh with several threads.
//
//   pages     The session's thread reads them. An idle thread gets the next few (page_feed.hpp).
//   topology  The curve is cut into parts of equally many pages. For each part a thread follows all
//             links from its pages, in a cache of its own, which also loads pages across the
//             border. What the stars of vertices show is added up.
//
// Threads only find out whether there is a fault; most meshes have none. As soon as one has found
// any, all end, and the session's thread repeats the pass: so the listed faults and their order
// depend neither on the number of threads nor on what their caches held. Nor does a fault escape
// them: some thread checks everything that one thread would.
#pragma once

#include "host/crew.hpp"
#include "query/check/check.hpp"
#include "query/pages/page_feed.hpp"

namespace abacus {

template <int D> class Check<D>::Together {
public:
    explicit Together(Check &check);

    static bool is_worth_while(const Host &host, const abacus_facts &facts);

    /// The passes; false if a fault was found, or the system grants no thread: then the result is
    /// unknown.
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
