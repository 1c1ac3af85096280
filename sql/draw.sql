-- How pictures are drawn: colours, light, contours, captions, a transparent background.
SELECT abacus_triangulate('hills', 'SELECT 100 * x + y, x, y, (x - 8) * (y - 5) AS height FROM generate_series(0, 16) x, generate_series(0, 12) y');
SELECT abacus_triangulate('rock', 'SELECT 100 * x + 10 * y + z, x, y, -z, x + y * z AS vs FROM generate_series(0, 6) x, generate_series(0, 4) y, generate_series(0, 4) z', dimension => 3);
CREATE FUNCTION png(bytea) RETURNS boolean RETURN substr($1, 2, 3) = 'PNG';
-- every ramp has colours of its own; the usual one is that for heights, or for what is inside the earth
SELECT count(DISTINCT abacus_draw('hills', 40, attribute => 'height', edges => false, ramp => ramp)) AS ramps,
       bool_or(abacus_draw('hills', 40, attribute => 'height', edges => false, ramp => ramp) = abacus_draw('hills', 40, attribute => 'height', edges => false) AND ramp = 'terrain') AS usual,
       bool_or(abacus_draw_section('rock', '{3,2,-2}', '{0,1,0}', 40, attribute => 'vs', ramp => ramp) = abacus_draw_section('rock', '{3,2,-2}', '{0,1,0}', 40, attribute => 'vs') AND ramp = 'strata') AS usual_section
FROM unnest('{terrain,strata,viridis,magma,cividis,grey,diverging}'::text[]) AS ramp;
-- light from another side, contours, captions, transparency: each makes another picture
SELECT count(DISTINCT picture) FROM (VALUES
    (abacus_draw('hills', 200, attribute => 'height', exaggeration => 0.1)),
    (abacus_draw('hills', 200, attribute => 'height', exaggeration => 0.1, light => '{90,30}')),
    (abacus_draw('hills', 200, attribute => 'height', exaggeration => 0.1, contours => 8)),
    (abacus_draw('hills', 200, attribute => 'height', exaggeration => 0.1, legend => 'm')),
    (abacus_draw('hills', 200, attribute => 'height', exaggeration => 0.1, scale_bar => 'km')),
    (abacus_draw('hills', 200, attribute => 'height', lower => '{-1,-1}', upper => '{17,13}')),
    (abacus_draw('hills', 200, attribute => 'height', lower => '{-1,-1}', upper => '{17,13}', transparent => true))) AS pictures (picture);
SELECT abacus_draw('hills', 60, attribute => 'height', exaggeration => 0.1, light => '{315,45}') = abacus_draw('hills', 60, attribute => 'height', exaggeration => 0.1) AS same_light,
       abacus_draw('hills', 60, attribute => 'height', contours => 8) = abacus_draw('hills', 60, attribute => 'height', contours => 8) AS same_again;
-- a range of the colours leaves the shading as it is: values beyond it get the colour at its end
SELECT count(DISTINCT abacus_draw('hills', 60, attribute => 'height', edges => false, exaggeration => 0.1, range => range)) AS shaded,
       bool_or(abacus_draw('hills', 60, attribute => 'height', edges => false, exaggeration => 0.1, range => range)
             = abacus_draw('hills', 60, attribute => 'height', edges => false, range => range)) AS flat
FROM (VALUES ('{100,200}'::float8[]), ('{1000,1001}'), ('{1e9,1e300}')) AS r (range);
SELECT png(abacus_draw('hills', 300, ramp => 'viridis', attribute => 'height', contours => 4, legend => 'µg/m³', scale_bar => '', transparent => true)) AS map,
       png(abacus_draw_section('rock', '{3,2,-2}', '{0,1,0}', 300, attribute => 'vs', contours => 0.5, legend => '', scale_bar => 'm', ramp => 'magma', transparent => true)) AS section,
       png(abacus_draw('hills', 300, legend => NULL, contours => NULL, ramp => NULL, light => NULL, scale_bar => 'm', transparent => NULL)) AS mesh;
-- values on contours: the line has gaps for them, and each fifth is wider
SELECT abacus_draw('hills', 300, attribute => 'height', contours => 2, contour_labels => true) <> abacus_draw('hills', 300, attribute => 'height', contours => 2) AS is_drawn,
       abacus_draw('hills', 300, attribute => 'height', contours => 2, contour_labels => true) = abacus_draw('hills', 300, attribute => 'height', contours => 2, contour_labels => true) AS same_again,
       abacus_draw('hills', 300, attribute => 'height', contours => 2, contour_labels => false) = abacus_draw('hills', 300, attribute => 'height', contours => 2, contour_labels => NULL) AS off;
SELECT abacus_draw('hills', 40, attribute => 'height', contour_labels => true) = abacus_draw('hills', 40, attribute => 'height') AS same;
-- without values these have no effect, which is told
SELECT abacus_draw('hills', 40, ramp => 'grey', contours => 2, legend => 'm', light => '{0,45}') = abacus_draw('hills', 40) AS same;
SELECT abacus_draw('hills', 40, attribute => 'height', light => '{0,45}') = abacus_draw('hills', 40, attribute => 'height') AS same;
-- what cannot be drawn
SELECT abacus_draw('hills', 40, attribute => 'height', ramp => 'rainbow');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', ramp => '');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', contours => 0);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', contours => 'NaN');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', contours => 1e-6);
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', exaggeration => 1, light => '{0,0}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', exaggeration => 1, light => '{NaN,45}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', exaggeration => 1, light => '{0,91}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw('hills', 40, attribute => 'height', exaggeration => 1, light => '{0,45,1}');
\echo :LAST_ERROR_SQLSTATE
SELECT abacus_draw_section('rock', '{3,2,-2}', '{0,1,0}', 40, attribute => 'vs', contours => -1);
\echo :LAST_ERROR_SQLSTATE
DROP FUNCTION png;
DROP TABLE hills, rock;
