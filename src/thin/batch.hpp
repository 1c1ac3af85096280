// Vertices that are looked at together: by several threads, if there are many.
#pragma once

#include "host/crew.hpp"
#include "thin/finder.hpp"

namespace abacus {

template <int D> class Batch {
public:
    using Options = typename Finder<D>::Options;

    /// `facts`: of the thinned mesh, whose host this is. `options`: of all finders together.
    Batch(const Host &host, const abacus_facts &facts, const Options &options,
          typename Finder<D>::Aim aim)
        : host_(host), facts_(facts), options_(share(host, options)), aim_(aim),
          most_(host.has_tiny_intervals() ? tiny : most), vertices_(host), outside_(host),
          crew_(host), finders_(host, host.threads()) {}

    /// Room for one more vertex.
    std::uint64_t *add() { return vertices_.extend(options_.vertex_words); }
    bool is_full() const { return size() >= most_; }
    std::size_t size() const { return vertices_.size() / options_.vertex_words; }

    /// Looks at the vertices, and forgets them. Calls outside(vertex) for those outside of the
    /// mesh, and candidate(words) for candidates.
    template <class Outside, class Candidate> void look(Outside outside, Candidate candidate) {
        outside_.resize(size());
        const std::size_t pieces = (size() + piece - 1) / piece;
        const bool is_shared =
            host_.threads() > 1 && (pieces > 1 || host_.has_tiny_intervals()) &&
            crew_.run_each(host_.threads(), pieces, [&](std::size_t number, const Host &host) {
                look_at(finders_.get(host, facts_, options_, aim_), number, host);
            });
        if (!is_shared) {
            if (!own_) own_.emplace(host_, facts_, options_, aim_);
            for (std::size_t number = 0; number < pieces; ++number) look_at(*own_, number, host_);
        }
        for (std::size_t i = 0; i < size(); ++i)
            if (outside_[i] != 0) outside(vertex(i));
        vertices_.clear();
        each_finder([&](Finder<D> &finder) { hand_on(finder, candidate); });
    }
    /// After the last vertex: the candidates that are left.
    template <class Candidate> void finish(Candidate candidate) {
        each_finder([&](Finder<D> &finder) {
            finder.flush();
            hand_on(finder, candidate);
        });
    }
    double greatest() {
        double greatest = 0;
        each_finder(
            [&](const Finder<D> &finder) { greatest = std::max(greatest, finder.greatest()); });
        return greatest;
    }

private:
    static constexpr std::size_t most = std::size_t{1} << 15, piece = std::size_t{1} << 11;
    /// For tests.
    static constexpr std::size_t tiny = 61;

    static Options share(const Host &host, Options options) {
        options.cache_bytes /= host.threads();
        return options;
    }
    const std::uint64_t *vertex(std::size_t i) const {
        return vertices_.data() + i * options_.vertex_words;
    }
    void look_at(Finder<D> &finder, std::size_t number, const Host &host) {
        host.poll();
        const std::size_t end = std::min(size(), (number + 1) * piece);
        for (std::size_t i = number * piece; i < end; ++i)
            outside_[i] = finder.look(vertex(i)) ? 1 : 0;
    }
    template <class Candidate> static void hand_on(Finder<D> &finder, Candidate candidate) {
        Arena<std::uint64_t> &words = finder.candidates();
        for (std::size_t at = 0; at < words.size(); at += finder.stride())
            candidate(words.data() + at);
        words.clear();
    }
    template <class Visit> void each_finder(Visit visit) {
        if (own_) visit(*own_);
        finders_.each(visit);
    }

    const Host &host_;
    const abacus_facts facts_;
    const Options options_;
    const typename Finder<D>::Aim aim_;
    const std::size_t most_;
    Arena<std::uint64_t> vertices_;
    Arena<std::uint8_t> outside_;
    std::optional<Finder<D>> own_; // the session's
    Crew crew_;
    OfEachThread<Finder<D>> finders_; // before the crew they go
};

} // namespace abacus
