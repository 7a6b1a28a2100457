/* SPDX-License-Identifier: BSD-3-Clause */
#include "trials.h"

#include <inttypes.h>
#include <pthread.h>

/* What the threads share; all that changes is guarded by `lock`. */
typedef struct {
  const trial_setup* setup;
  const run_options* options;
  FILE* record;
  bool (*save)(const run_options*, const run_result*);
  pthread_mutex_t lock;
  run_result* result;
  int next; /* of the trials asked for, the first that no thread has taken */
  bool good;
} trial_pool;

/* The next trial to be run, counted from 0; the number of all if there is none. */
static int take_next(trial_pool* pool) {
  const run_options* o = pool->options;
  pthread_mutex_lock(&pool->lock);
  while (pool->next < o->trials && has_trial(pool->result, o->seed + (uint64_t)pool->next)) ++pool->next;
  const int taken = pool->good && pool->next < o->trials ? pool->next++ : o->trials;
  pthread_mutex_unlock(&pool->lock);
  return taken;
}

static bool run_one(const trial_pool* pool, int i, trial_result* trial) {
  const run_options* o = pool->options;
  const uint64_t seed = o->seed + (uint64_t)i;
  double pose[7];
  const tactus_status status = o->has_true_pose ? tactus_pose_from_rpy(o->true_pose, pose)
                                                : tactus_scenario_sample_pose(pool->setup->scenario, seed, pose);
  if (status == TACTUS_OK) return run_trial(pool->setup, seed, pose, i == 0 ? pool->record : NULL, trial);
  fprintf(stderr, "tactus run: seed %" PRIu64 ": %s\n", seed, tactus_last_error());
  return false;
}

static bool keep(trial_pool* pool, const trial_result* trial) {
  if (!add_trial(pool->result, trial)) {
    fprintf(stderr, "tactus run: seed %" PRIu64 ": out of memory\n", trial->seed);
    return false;
  }
  fprintf(stderr, "seed %-4" PRIu64 " ended: %s, %s; %d of %d trials are done\n", trial->seed,
          trial_end_name(trial->ended), trial->inserted ? "inserted" : "not inserted", pool->result->count,
          pool->options->trials);
  return pool->save(pool->options, pool->result);
}

static void* work(void* shared) {
  trial_pool* pool = shared;
  for (int i; (i = take_next(pool)) < pool->options->trials;) {
    trial_result trial;
    const bool ran = run_one(pool, i, &trial);
    pthread_mutex_lock(&pool->lock);
    pool->good = ran && keep(pool, &trial) && pool->good;
    pthread_mutex_unlock(&pool->lock);
  }
  return NULL;
}

bool run_trials(const trial_setup* setup, const run_options* options, FILE* record,
                bool (*save)(const run_options*, const run_result*), run_result* result) {
  trial_pool pool = {setup, options, record, save, PTHREAD_MUTEX_INITIALIZER, result, 0, true};
  pthread_t threads[most_jobs];
  int started = 0;
  while (started + 1 < options->jobs && pthread_create(&threads[started], NULL, work, &pool) == 0) ++started;
  if (started + 1 < options->jobs)
    fprintf(stderr, "tactus run: --jobs: found room for %d threads, expected %d; going on with these\n", started + 1,
            options->jobs);
  work(&pool);
  for (int i = 0; i < started; ++i) pthread_join(threads[i], NULL);
  pthread_mutex_destroy(&pool.lock);
  return pool.good;
}
