/* Finds the weighted Fermat point of a triangle: the point with the smallest weighted sum of
 * distances from the corners.
 *
 * At a minimum inside the triangle, the three weighted unit vectors to the corners sum to zero.
 * They form a triangle with the sides w_i. Seen from the minimum, two corners are therefore pi -
 * theta_i apart, where theta_i is the angle of that triangle opposite the third weight. The point
 * with these angles has the barycentric coordinates 1 / h_i (not normalised), with h_i = cot A_i +
 * cot theta_i and A_i the angle of the corner. For equal weights this is the classical csc(A + 60
 * deg) construction.
 *
 * h_i <= 0 means that the other two corners appear from corner i at too wide an angle; then corner
 * i is the minimum. Corner i is also the minimum if its weight is at least the sum of the other
 * two. All h_i are multiplied by sin A and sin theta, so that nothing is divided by an area that
 * may be zero.
 *
 * On the line through the first two corners, at x, the sum is a constant plus w_0 x - w_1 x + w_2
 * sqrt(h^2 + (x - f)^2), with the third corner at the height h above f. It is least where the third
 * corner's unit vector has the component (w_1 - w_0) / w_2 along the line, or at an end. */
#include "grow/cco/fermat.h"

/* Returns the result for a minimum at corner i. */
static Fermat at_corner(const Vec3 corner[3], const double weight[3], int i)
{
    int j = (i + 1) % 3, k = (i + 2) % 3;
    Vec3 to_j = vec3_normalized(vec3_sub(corner[j], corner[i]));
    Vec3 to_k = vec3_normalized(vec3_sub(corner[k], corner[i]));
    return (Fermat){corner[i], i, vec3_add_scaled(vec3_scale(to_j, weight[j]), to_k, weight[k])};
}

Fermat fermat_point(const Vec3 corner[3], const double weight[3])
{
    double square[3], cosine[3]; /* of the weights; 2 w_j w_k cos theta_i */
    for (int i = 0; i < 3; i++)
        square[i] = weight[i] * weight[i];
    for (int i = 0; i < 3; i++)
        cosine[i] = square[(i + 1) % 3] + square[(i + 2) % 3] - square[i];
    for (int i = 0; i < 3; i++)
        if (weight[i] >= weight[(i + 1) % 3] + weight[(i + 2) % 3])
            return at_corner(corner, weight, i);
    /* Heron: 2 w_j w_k sin theta_i, the same for all i. */
    double weight_sine = sqrt(fmax(0, 4 * square[0] * square[1] - cosine[2] * cosine[2]));

    Vec3 edge[3]; /* edge[i] lies opposite corner i */
    for (int i = 0; i < 3; i++)
        edge[i] = vec3_sub(corner[(i + 2) % 3], corner[(i + 1) % 3]);
    double corner_sine = vec3_length(vec3_cross(edge[0], edge[1]));
    double h[3];
    for (int i = 0; i < 3; i++) {
        double corner_cosine = -vec3_dot(edge[(i + 1) % 3], edge[(i + 2) % 3]);
        h[i] = corner_cosine * weight_sine + corner_sine * cosine[i];
        if (!(h[i] > 0))
            return at_corner(corner, weight, i);
    }
    double share[3] = {h[1] * h[2], h[2] * h[0], h[0] * h[1]};
    double scale = 1 / (share[0] + share[1] + share[2]);
    Vec3 place = vec3_scale(corner[0], share[0] * scale);
    place = vec3_add_scaled(place, corner[1], share[1] * scale);
    place = vec3_add_scaled(place, corner[2], share[2] * scale);
    return (Fermat){place, -1, vec3(0, 0, 0)};
}

Vec3 fermat_point_between(const Vec3 corner[3], const double weight[3], const double margin[2])
{
    Vec3 along = vec3_sub(corner[1], corner[0]), to_third = vec3_sub(corner[2], corner[0]);
    double length = vec3_length(along);
    double low = margin[0], high = length - margin[1];
    Vec3 unit = vec3_scale(along, 1 / length);
    double foot = vec3_dot(to_third, unit);
    double height = vec3_length(vec3_add_scaled(to_third, unit, -foot));
    double pull = (weight[1] - weight[0]) / weight[2];
    double x = pull >= 1 ? high : pull <= -1 ? low : foot + height * pull / sqrt(1 - pull * pull);
    x = low > high ? (low + high) / 2 : fmin(fmax(x, low), high);
    return vec3_add_scaled(corner[0], unit, x);
}
