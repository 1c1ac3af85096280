#include "draw/letters.hpp"

#include <cairo.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace abacus {

namespace {

// A letter lies on a grid. Capitals are 6 high, from row 0 to row 6, the baseline; there are two
// more rows below it. Its strokes are lines through points, two digits each: column and row.
struct Letter {
    std::uint32_t code;
    int width;
    const char *strokes;
};

// In the order of their codes.
constexpr Letter letters[] = {
    {' ', 1, ""},
    {'!', 0, "0004 0506"},
    {'"', 2, "0001 2021"},
    {'#', 4, "1016 3036 0242 0444"},
    {'%', 4, "4006 0010110100 3545463635"},
    {'\'', 0, "0001"},
    {'(', 1, "10010516"},
    {')', 1, "00111506"},
    {'*', 2, "0123 2103 1014"},
    {'+', 4, "0444 2226"},
    {',', 1, "1507"},
    {'-', 2, "0424"},
    {'.', 0, "0506"},
    {'/', 3, "3006"},
    {'0', 4, "103041453616050110"},
    {'1', 2, "022026"},
    {'2', 4, "01103041420646"},
    {'3', 4, "004022324345361605"},
    {'4', 4, "36300444"},
    {'5', 4, "40000312324345361605"},
    {'6', 4, "4020020516364544331304"},
    {'7', 4, "004016"},
    {'8', 4, "13020110304142331304051636454433"},
    {'9', 4, "0626444130100102133342"},
    {':', 0, "0203 0506"},
    {';', 1, "1213 1507"},
    {'<', 3, "320436"},
    {'=', 3, "0333 0535"},
    {'>', 3, "023406"},
    {'?', 4, "01103041422324 2526"},
    {'A', 4, "062046 1434"},
    {'B', 4, "060030414233033344453606"},
    {'C', 4, "4130100105163645"},
    {'D', 4, "00062644422000"},
    {'E', 4, "40000646 0333"},
    {'F', 4, "400006 0333"},
    {'G', 4, "41301001051636454323"},
    {'H', 4, "0006 4046 0343"},
    {'I', 0, "0006"},
    {'J', 3, "3035261605"},
    {'K', 4, "0006 4004 1346"},
    {'L', 4, "000646"},
    {'M', 4, "0600234046"},
    {'N', 4, "06004640"},
    {'O', 4, "103041453616050110"},
    {'P', 4, "06003041423303"},
    {'Q', 4, "103041453616050110 2446"},
    {'R', 4, "06003041423303 2346"},
    {'S', 4, "413010010213334445361605"},
    {'T', 4, "0040 2026"},
    {'U', 4, "000516364540"},
    {'V', 4, "002640"},
    {'W', 4, "0016233640"},
    {'X', 4, "0046 4006"},
    {'Y', 4, "002340 2326"},
    {'Z', 4, "00400646"},
    {'[', 1, "10000616"},
    {'\\', 3, "0036"},
    {']', 1, "00101606"},
    {'^', 2, "021022"},
    {'_', 4, "0646"},
    {'a', 3, "3236 3322120305162635"},
    {'b', 3, "0006 0312223335261605"},
    {'c', 3, "3322120305162635"},
    {'d', 3, "3036 3322120305162635"},
    {'e', 3, "04343322120305162635"},
    {'f', 2, "201116 0222"},
    {'g', 3, "3237281807 3322120305162635"},
    {'h', 3, "0006 0312223336"},
    {'i', 0, "0206 0001"},
    {'j', 1, "121708 1011"},
    {'k', 3, "0006 3205 1436"},
    {'l', 0, "0006"},
    {'m', 4, "0206 03122326 23324346"},
    {'n', 3, "0206 0312223336"},
    {'o', 3, "122233352616050312"},
    {'p', 3, "0208 0312223335261605"},
    {'q', 3, "3238 3322120305162635"},
    {'r', 2, "0206 031222"},
    {'s', 3, "33221203142435261605"},
    {'t', 2, "101526 0222"},
    {'u', 3, "0205162635 3236"},
    {'v', 4, "022642"},
    {'w', 4, "0216233642"},
    {'x', 3, "0236 3206"},
    {'y', 4, "0226 4218"},
    {'z', 3, "02320636"},
    {'|', 0, "0007"},
    {0xb0, 2, "1021120110"},
    {0xb2, 2, "0110210323"},
    {0xb3, 2, "002011221303"},
    {0xb5, 3, "0208 05162635 3236"},
    {0xb7, 0, "0304"},
    {0x3bc, 3, "0208 05162635 3236"},
};
constexpr Letter box{0, 4, "0040460600"};

constexpr double grid_height = 6, gap = 2;

const Letter &letter_of(std::uint32_t code) {
    const auto *const found =
        std::lower_bound(std::begin(letters), std::end(letters), code,
                         [](const Letter &l, std::uint32_t c) { return l.code < c; });
    return found != std::end(letters) && found->code == code ? *found : box;
}

/// Calls visit(letter, x) for each letter, with x in rows of the grid; returns the total width.
template <class Visit> double each_letter(std::string_view text, Visit visit) {
    double x = 0;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i++]);
        // The first byte of a longer character says by its leading ones how many bytes there are.
        std::uint32_t code = lead < 0xc0 ? lead : lead < 0xe0 ? lead & 31 : lead & 15;
        while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80)
            code = code << 6 | (static_cast<unsigned char>(text[i++]) & 63);
        const Letter &letter = letter_of(code);
        visit(letter, x);
        x += letter.width + gap;
    }
    return std::max(x - gap, 0.0);
}

} // namespace

double text_width(std::string_view text, double height) {
    return each_letter(text, [](const Letter &, double) {}) * height / grid_height;
}

void draw_text(cairo_t *pen, double x, double baseline, std::string_view text, double height,
               double width) {
    const double scale = height / grid_height;
    each_letter(text, [&](const Letter &letter, double from) {
        bool is_first = true;
        for (const char *s = letter.strokes; *s != '\0';) {
            if (*s == ' ') {
                is_first = true;
                ++s;
                continue;
            }
            const double at_x = x + (from + (s[0] - '0')) * scale;
            const double at_y = baseline + (s[1] - '0' - grid_height) * scale;
            is_first ? cairo_move_to(pen, at_x, at_y) : cairo_line_to(pen, at_x, at_y);
            is_first = false;
            s += 2;
        }
    });
    cairo_set_line_width(pen, height * width);
    cairo_set_line_cap(pen, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(pen);
}

} // namespace abacus
