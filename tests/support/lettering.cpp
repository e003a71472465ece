#include <cctype>
#include <map>
#include <string>

#include "tests/support/image.h"

namespace lpf::test {
namespace {

/// Each letter as lines over a lattice of 5 x 7 nodes: "xy" pairs from the top left, lines parted
/// by blanks. Small letters are drawn as capitals.
const std::map<char, std::string>& letters() {
    static const std::map<char, std::string> table = {
        {'A', "062046 1434"},
        {'B', "00063645443303 3342413000"},
        {'C', "4130100105163645"},
        {'D', "00062644422000"},
        {'E', "40000646 0333"},
        {'F', "400006 0333"},
        {'G', "41301001051636454323"},
        {'H', "0006 4046 0343"},
        {'I', "1030 2026 1636"},
        {'J', "4045361605"},
        {'K', "0006 4003 0346"},
        {'L', "000646"},
        {'M', "0600234046"},
        {'N', "06004640"},
        {'O', "103041453616050110"},
        {'P', "06003041423303"},
        {'Q', "103041453616050110 2446"},
        {'R', "06003041423303 2346"},
        {'S', "413010010213334445361605"},
        {'T', "0040 2026"},
        {'U', "000516364540"},
        {'V', "002640"},
        {'W', "0016233640"},
        {'X', "0046 4006"},
        {'Y', "002340 2326"},
        {'Z', "00400646"},
        {'0', "103041453616050110 1531"},
        {'1', "112026 1636"},
        {'2', "01103041420646"},
        {'3', "01103041423313 334445361605"},
        {'4', "36300444"},
        {'5', "4000033344453616"},
        {'6', "30100105163645443303"},
        {'7', "004026"},
        {'8', "103041423313020110 133344453616050413"},
        {'9', "16364541301001021343"},
        {'.', "2526"},
        {',', "2516"},
        {':', "2122 2425"},
        {'%', "0640 0001111000 3536464535"},
        {'=', "0242 0444"},
        {'-', "1333"},
        {'+', "0343 2125"},
        {'/', "0640"},
        {'(', "30212536"},
        {')', "10212516"},
    };
    return table;
}

Eigen::Vector2d node(char x, char y) { return {x - '0', y - '0'}; }

}  // namespace

void Image::write(const std::string& text, int x, int y, double size, const Colour& colour) {
    const double unit = size / 6;
    Eigen::Vector2d corner(x, y);
    for (const char character : text) {
        const auto found =
            letters().find(static_cast<char>(std::toupper(static_cast<unsigned char>(character))));
        const std::string lines = found == letters().end() ? "" : found->second;
        for (std::size_t i = 0; i + 3 < lines.size(); i += 2) {
            if (lines[i] == ' ') ++i;
            if (i + 3 >= lines.size() || lines[i + 2] == ' ') continue;
            line(corner + unit * node(lines[i], lines[i + 1]),
                 corner + unit * node(lines[i + 2], lines[i + 3]), 0.9 * unit, colour);
        }
        corner.x() += 6 * unit;
    }
}

}  // namespace lpf::test
