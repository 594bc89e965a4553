/* The heat equation integrated: linearly implicit steps of second order with an error estimate, L-stable.
   Source: L. F. Shampine and M. W. Reichelt, The MATLAB ODE Suite, SIAM J. Sci. Comput. 18 (1997) 1, sec. 3 (ode23s). */
#include "joint_model.h"

#include <math.h>
#include <string.h>

#define GAMMA 0.29289321881345254   /* 1/(2 + sqrt 2) */
#define E32 7.4142135623730951      /* 6 + sqrt 2 */
#define SAFETY 0.8

/* Factors of a matrix, rows exchanged; 0 where it has none. */
static int factors(double matrix[STATES][STATES], int *pivots)
{
    int i, j, k;
    for (k = 0; k < STATES; k++) {
        int best = k;
        for (i = k + 1; i < STATES; i++)
            if (fabs(matrix[i][k]) > fabs(matrix[best][k])) best = i;
        pivots[k] = best;
        if (!(fabs(matrix[best][k]) > 0.0)) return 0;
        if (best != k)
            for (j = 0; j < STATES; j++) {
                double other = matrix[k][j];
                matrix[k][j] = matrix[best][j];
                matrix[best][j] = other;
            }
        for (i = k + 1; i < STATES; i++) {
            double share;
            if (matrix[i][k] == 0.0) continue;
            share = matrix[i][k] /= matrix[k][k];
            for (j = k + 1; j < STATES; j++) matrix[i][j] -= share * matrix[k][j];
        }
    }
    return 1;
}

static void solve(double matrix[STATES][STATES], const int *pivots, double *column)
{
    int i, j;
    for (i = 0; i < STATES; i++) {
        double other = column[pivots[i]];
        column[pivots[i]] = column[i];
        column[i] = other;
    }
    for (i = 0; i < STATES; i++)
        for (j = 0; j < i; j++) column[i] -= matrix[i][j] * column[j];
    for (i = STATES - 1; i >= 0; i--) {
        for (j = i + 1; j < STATES; j++) column[i] -= matrix[i][j] * column[j];
        column[i] /= matrix[i][i];
    }
}

/* I - h gamma J, of the entries of J as they are generated, column by column. */
static void implicit_matrix(const double *entries, double step, double matrix[STATES][STATES])
{
    int row, column, place;
    memset(matrix, 0, sizeof(double) * STATES * STATES);
    for (row = 0; row < STATES; row++) matrix[row][row] = 1.0;
    for (column = 0; column < STATES; column++)
        for (place = jacobian_columns[column]; place < jacobian_columns[column + 1]; place++)
            matrix[jacobian_rows[place]][column] -= step * GAMMA * entries[place];
}

/* One step from `state` with its rates and Jacobian: the state after it, and how large its error is, 1 at the limit. */
static double one_step(const double *state, const double *given, const double *rates_before, const double *entries,
                       double step, double *after)
{
    static const double worst = 1e10;
    double matrix[STATES][STATES], first[STATES], second[STATES], third[STATES], middle[STATES], last[STATES];
    double largest = 0.0;
    int pivots[STATES], i;
    implicit_matrix(entries, step, matrix);
    if (!factors(matrix, pivots)) return worst;
    for (i = 0; i < STATES; i++) first[i] = rates_before[i];
    solve(matrix, pivots, first);
    for (i = 0; i < STATES; i++) after[i] = state[i] + 0.5 * step * first[i];
    evaluate(rates, after, given, middle, 0);
    for (i = 0; i < STATES; i++) second[i] = middle[i] - first[i];
    solve(matrix, pivots, second);
    for (i = 0; i < STATES; i++) {
        second[i] += first[i];
        after[i] = state[i] + step * second[i];
    }
    evaluate(rates, after, given, last, 0);
    for (i = 0; i < STATES; i++)
        third[i] = last[i] - E32 * (second[i] - middle[i]) - 2.0 * (first[i] - rates_before[i]);
    solve(matrix, pivots, third);
    for (i = 0; i < STATES; i++) {
        double size = fmax(fabs(state[i]), fabs(after[i])) + 1.0;
        double error = fabs(step / 6.0 * (first[i] - 2.0 * second[i] + third[i])) / (TOLERANCE * size);
        if (!(error < worst)) return worst;
        largest = fmax(largest, error);
    }
    return largest;
}

int heat_advance(Joint *joint, double current, double air, double seconds)
{
    double given[GIVEN], now[STATES], entries[JACOBIAN_ENTRIES], after[STATES];
    double left = seconds;
    given[DRIVE] = current;
    given[AIR] = air;
    given[FREQUENCY] = joint->frequency;
    while (left > 1e-12 * seconds) {
        double step = fmin(joint->step, left), error;
        evaluate(rates_and_jacobian, joint->heat, given, now, entries);
        while ((error = one_step(joint->heat, given, now, entries, step, after)) > 1.0) {
            step *= fmax(0.2, SAFETY * pow(error, -1.0 / 3.0));
            joint->step = step;
            if (step < 1e-9 * FIRST_STEP) return 0;
        }
        memcpy(joint->heat, after, sizeof after);
        left -= step;
        /* A step cut short by the end of the interval says nothing against the longer one. */
        joint->step = fmax(joint->step, step * fmin(5.0, SAFETY * pow(fmax(error, 1e-6), -1.0 / 3.0)));
        if (joint->step > LONGEST_STEP) joint->step = LONGEST_STEP;
    }
    return 1;
}
