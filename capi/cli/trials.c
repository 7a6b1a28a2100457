/* SPDX-License-Identifier: BSD-3-Clause */
#include "trials.h"

#include <inttypes.h>
#include <pthread.h>
#include <string.h>

/* What the threads share; all that changes is guarded by `lock`. */
typedef struct {
  const campaign* of;
  pthread_mutex_t lock;
  int next; /* of the poses asked for, the first that no thread has taken */
  bool good;
} trial_pool;

/* What a thread does at a time: the missing trials of one pose. */
typedef struct {
  trial_pool* pool;
  uint64_t seed;
  double true_pose[7];
  head_start start; /* where trials of the phase of poses begin */
} pose_trials;

static uint64_t seed_of(const trial_pool* pool, int i) { return pool->of->options->seed + (uint64_t)i; }

static bool has_all(const campaign* all, uint64_t seed) {
  for (int s = 0; s < all->solvers; ++s)
    if (find_trial(&all->results[s], seed) == NULL) return false;
  return true;
}

/* The next pose with a trial to be run, counted from 0; the number of all if there is none. */
static int take_next(trial_pool* pool) {
  const int count = pool->of->options->trials;
  pthread_mutex_lock(&pool->lock);
  while (pool->next < count && has_all(pool->of, seed_of(pool, pool->next))) ++pool->next;
  const int taken = pool->good && pool->next < count ? pool->next++ : count;
  pthread_mutex_unlock(&pool->lock);
  return taken;
}

/* Whether a trial is missing, and nothing has gone wrong. */
static bool is_wanted(trial_pool* pool, int solver, uint64_t seed) {
  pthread_mutex_lock(&pool->lock);
  const bool wanted = pool->good && find_trial(&pool->of->results[solver], seed) == NULL;
  pthread_mutex_unlock(&pool->lock);
  return wanted;
}

static bool draw_pose(pose_trials* trials) {
  const campaign* all = trials->pool->of;
  const trial_options* o = all->options;
  const tactus_status status =
      o->has_true_pose ? tactus_pose_from_rpy(o->true_pose, trials->true_pose)
                       : tactus_scenario_sample_pose(all->setups->scenario, trials->seed, trials->true_pose);
  if (status == TACTUS_OK) return true;
  fprintf(stderr, "tactus: seed %" PRIu64 ": %s\n", trials->seed, tactus_last_error());
  return false;
}

/* The first solver leads to where the phase of poses begins. */
static bool lead(pose_trials* trials) {
  const campaign* all = trials->pool->of;
  if (all->options->phase != phase_poses) return true;
  const trial_course course = {true, NULL, &trials->start, NULL};
  trial_result led;
  if (!run_trial(all->setups, trials->seed, trials->true_pose, &course, &led)) return false;
  fprintf(stderr, "seed %-4" PRIu64 " %-9s led all to: %s\n", trials->seed,
          tactus_solver_name(all->setups->planner.solver), trial_end_name(led.ended));
  return true;
}

static int count_done(const campaign* all) {
  int count = 0;
  for (int s = 0; s < all->solvers; ++s) count += all->results[s].count;
  return count;
}

static bool add_and_save(const campaign* all, int solver, const trial_result* trial) {
  if (!add_trial(&all->results[solver], trial)) {
    fprintf(stderr, "tactus: seed %" PRIu64 ": out of memory\n", trial->seed);
    return false;
  }
  fprintf(stderr, "seed %-4" PRIu64 " %-9s ended: %s, %s; %d of %d trials are done\n", trial->seed,
          tactus_solver_name(all->setups[solver].planner.solver), trial_end_name(trial->ended),
          trial->inserted ? "inserted" : "not inserted", count_done(all), all->solvers * all->options->trials);
  return save_results(all->file);
}

static bool keep(trial_pool* pool, int solver, const trial_result* trial) {
  pthread_mutex_lock(&pool->lock);
  const bool kept = add_and_save(pool->of, solver, trial);
  pthread_mutex_unlock(&pool->lock);
  return kept;
}

static bool run_one(pose_trials* trials, int solver) {
  const campaign* all = trials->pool->of;
  const trial_phase phase = all->options->phase;
  const bool first = solver == 0 && trials->seed == all->options->seed;
  const trial_course course = {phase == phase_voxels, phase == phase_poses ? &trials->start : NULL, NULL,
                               first ? all->record : NULL};
  trial_result trial;
  return run_trial(&all->setups[solver], trials->seed, trials->true_pose, &course, &trial) &&
         keep(trials->pool, solver, &trial);
}

static bool run_pose(trial_pool* pool, uint64_t seed) {
  pose_trials trials;
  memset(&trials, 0, sizeof trials);
  trials.pool = pool;
  trials.seed = seed;
  bool good = draw_pose(&trials) && lead(&trials);
  for (int s = 0; good && s < pool->of->solvers; ++s)
    if (is_wanted(pool, s, seed)) good = run_one(&trials, s);
  free_head_start(&trials.start);
  return good;
}

static void* work(void* shared) {
  trial_pool* pool = shared;
  for (int i; (i = take_next(pool)) < pool->of->options->trials;) {
    const bool ran = run_pose(pool, seed_of(pool, i));
    pthread_mutex_lock(&pool->lock);
    pool->good = ran && pool->good;
    pthread_mutex_unlock(&pool->lock);
  }
  return NULL;
}

bool run_trials(const campaign* all) {
  trial_pool pool = {all, PTHREAD_MUTEX_INITIALIZER, 0, true};
  const int jobs = all->options->jobs;
  pthread_t threads[most_jobs];
  int started = 0;
  while (started + 1 < jobs && pthread_create(&threads[started], NULL, work, &pool) == 0) ++started;
  if (started + 1 < jobs)
    fprintf(stderr, "tactus: --jobs: found room for %d threads, expected %d; going on with these\n", started + 1, jobs);
  work(&pool);
  for (int i = 0; i < started; ++i) pthread_join(threads[i], NULL);
  pthread_mutex_destroy(&pool.lock);
  return pool.good;
}
