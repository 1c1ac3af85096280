// Points of the earthquake data sets behind the C interface.
#include "quake/quake_points.hpp"

#include "capi/guard.hpp"
#include "capi/handle.hpp"

#include <abacus/quake.h>

struct abacus_quake {
    abacus_quake(const abacus_host *table, double frequency, double points_per_wavelength)
        : host(*table), points(frequency, points_per_wavelength) {}

    const abacus::Host host;
    abacus::QuakePoints points;
};

abacus_status abacus_quake_open(const abacus_host *host, double frequency,
                                double points_per_wavelength, abacus_quake **quake,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        *quake = abacus::create_handle<abacus_quake>(host, frequency, points_per_wavelength);
        return ABACUS_OK;
    });
}

abacus_status abacus_quake_next(abacus_quake *quake, abacus_quake_point *point,
                                abacus_error *error) {
    return abacus::guard(error, [&] {
        quake->host.poll();
        abacus::QuakePoint next;
        if (!quake->points.next(next)) return ABACUS_END;
        *point = {next.id,
                  {next.x, next.y, next.z},
                  next.material.vs,
                  next.material.vp,
                  next.material.density};
        return ABACUS_OK;
    });
}

void abacus_quake_close(abacus_quake *quake) { abacus::destroy_handle(quake); }
