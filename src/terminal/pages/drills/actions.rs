//! Implementation of the drill page's key actions on the library and the records, and of the answers to its questions.

use crate::{
    drills::{Category, Exercise, Goal, Session, Venue, decode, encode, exam},
    game::Rule,
    table::CueBall,
    terminal::{
        DrillAction as Action, DrillCondition, DrillContext, DrillTask, Effect,
        pages::{
            Page,
            drills::{
                DrillsPage, ExamResult, Question, TransferredPosition, Turn, question::MAX_TEXT_LENGTH,
                turn_actions::tasks_effect,
            },
            moved_index,
        },
        shot::film,
        ui::{Message, TextField},
        words::player_words,
    },
};

impl DrillsPage {
    /// Returns the reason why a key binding is disabled now; `None` if it is enabled.
    pub fn disabled_reason(&self, when: DrillCondition) -> Option<&'static str> {
        let refuse = |refused: bool, reason| refused.then_some(reason);
        match when {
            DrillCondition::Always => None,
            DrillCondition::Marked => refuse(self.catalogue.marked().is_none(), "no exercise is listed; 0 lists all"),
            DrillCondition::MarkedOwn => self
                .disabled_reason(DrillCondition::Marked)
                .or(refuse(!self.catalogue.is_own_marked(), "bundled exercises cannot be removed, only my positions")),
            DrillCondition::Filtered => refuse(!self.catalogue.is_filtered(), "everything is listed"),
            DrillCondition::Searching => refuse(!self.catalogue.is_searching(), "no words are looked for"),
            DrillCondition::NotSearching => refuse(self.catalogue.is_searching(), "Esc ends the search first"),
            DrillCondition::OpenedFromExercise => {
                refuse(self.records.exercise.is_none(), "this record is of all exercises")
            }
            DrillCondition::HasFilm => refuse(self.film.played().is_none(), "there is no filmed shot on the table yet"),
            DrillCondition::HasEstimate => {
                refuse(self.records.skill().is_none(), "there is no estimate of your skill yet")
            }
            _ => match &self.turn {
                Some(turn) => turn.disabled_reason(when),
                None => Some("no exercise is open"),
            },
        }
    }

    /// Performs the action of an enabled key binding.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Back => {
                self.back();
                return self.retry();
            }
            Action::MoveMark(lines) if self.page() == DrillContext::Record => {
                let all = self.book.sessions_of(self.records.scope()).len();
                self.records.scroll(lines, all);
            }
            Action::MoveMark(lines) if self.page() == DrillContext::Films => self.film.move_mark(lines),
            Action::MoveMark(lines) if self.page() == DrillContext::Match => self.match_setup.move_mark(lines),
            Action::MoveMark(lines) if self.page() == DrillContext::Result => {
                if let Some(result) = &mut self.exam_result {
                    result.mark = moved_index(result.mark, lines, result.session.attempts.len());
                }
            }
            Action::MoveMark(lines) => self.catalogue.move_mark(lines),
            Action::OpenFilms => self.open_films(),
            Action::Open if self.page() == DrillContext::Films => return self.open_film(0),
            Action::Open if self.page() == DrillContext::Result => return self.open_from_result(),
            Action::CycleFilm(shots) => return self.open_film(shots),
            Action::Playback(key) if self.page() == DrillContext::Film => self.film.apply_playback_key(key),
            Action::CycleCategory(step) => self.catalogue.choose_category(step),
            Action::ToggleGrade(grade) => self.catalogue.choose_grade(grade),
            Action::ShowAll if self.catalogue.matches_elsewhere() > 0 => self.catalogue.search_everywhere(),
            Action::ShowAll => self.catalogue.show_all(),
            Action::ClearSearch => self.catalogue.search(""),
            Action::Search => {
                let marked = self.catalogue.marked().map(|exercise| exercise.name.clone()).unwrap_or_default();
                let before = self.catalogue.search_text();
                self.question = Some(Question::Search { typed: TextField::new(MAX_TEXT_LENGTH), before, marked });
            }
            Action::Open => return self.open_marked(),
            Action::DrawExam(level) => return self.begin_exam(level),
            Action::SetUpMatch => self.set_up_match(),
            Action::ChooseValue(step) => self.match_setup.choose(step),
            Action::BeginMatch => return self.ask_to_begin_match(),
            Action::DiscardExam => self.ask_to_discard(),
            Action::BeginExam => self.pages = vec![DrillContext::Library, DrillContext::Exercise],
            Action::OpenRecord => return Some(self.open_records()),
            Action::ToggleRecordScope => self.records.toggle_scope(),
            Action::SaveSkill => {
                return self.records.skill().map(|skill| Effect::Drill(vec![DrillTask::SaveSkill(skill)]));
            }
            Action::Share => return self.share(),
            Action::AddByCode => self.question = Some(Question::Code(TextField::new(MAX_TEXT_LENGTH))),
            Action::Remove => {
                self.question = self.catalogue.marked().map(|exercise| Question::Remove(exercise.name.clone()));
            }
            Action::NextPlayer if self.turn.is_none() => {
                self.player.choose_next();
                self.message = Some(Message::plain(format!("the player: {}", player_words(self.player.skill))));
            }
            Action::SendToCoach => self.send_to_coach(),
            Action::Answer(true) => return self.accept_answer(),
            Action::Answer(false) => self.decline_answer(),
            other => return self.update_turn(other),
        }
        None
    }

    fn back(&mut self) {
        let is_exercise = self.page() == DrillContext::Exercise;
        let exam = self.turn.as_mut().filter(|turn| is_exercise && turn.session.is_exam() && !turn.session.is_over());
        if let Some(exam) = exam {
            exam.finish_watching();
            // An exam without attempts needs no confirmation.
            let made = exam.latest_session().attempts.len();
            if made > 0 {
                self.question = Some(Question::Leave(made, exam.session.exercises.len()));
                return;
            }
        }
        self.pages.pop();
        self.film.playback.pause();
        let below = self.page();
        if matches!(below, DrillContext::Library | DrillContext::Result) {
            let kept = self.turn.as_ref().filter(|turn| turn.is_in_progress()).map(|turn| turn.session.goal);
            self.leave_page();
            self.pages.extend(Some(below).filter(|below| *below == DrillContext::Result));
            if let Some(goal) = kept {
                let how = match goal {
                    Goal::Match { against_coach: true, .. } => "F9 goes on with it",
                    goal if goal.is_game() => {
                        "Enter on the exercise goes on with it, c on the coach's page at the next start"
                    }
                    _ => "Enter on the exercise goes on with it",
                };
                self.message = Some(Message::plain(format!("the {} is kept; {how}", goal.name())));
            }
        }
    }

    /// Tries again to save what the disk has refused, if there is anything.
    fn retry(&self) -> Option<Effect> {
        self.has_unsaved().then(|| Effect::Drill(vec![DrillTask::SaveUnsaved]))
    }

    /// Returns to the library, or to the coach page if the library is left too.
    fn leave_page(&mut self) {
        let is_closed = self.is_closed();
        self.close_exercise();
        if !is_closed {
            self.pages = vec![DrillContext::Library];
        }
    }

    /// Asks whether to discard the exam that is under way. One without attempts is left without a question.
    fn ask_to_discard(&mut self) {
        let Some(exam) = &mut self.turn else { return };
        exam.finish_watching();
        match exam.latest_session().attempts.len() {
            0 => self.leave_page(),
            made => self.question = Some(Question::Discard(made, exam.session.exercises.len())),
        }
    }

    fn open_marked(&mut self) -> Option<Effect> {
        let exercise = self.catalogue.marked()?.clone();
        Some(self.open_exercise(exercise))
    }

    /// Opens the marked exercise of an exam for practice. Leaving it leads back to the result.
    fn open_from_result(&mut self) -> Option<Effect> {
        let ExamResult { session, mark } = self.exam_result.as_ref()?;
        let drawn = session.exercise_of(session.attempts.get(*mark)?)?;
        // The library's exercise has the chances at a real table, unlike that of an exam.
        let exercise = self.catalogue.library.get(&drawn.name).unwrap_or(drawn).clone();
        self.close_exercise();
        let effect = self.open_exercise(exercise);
        let opened = Some(self.page()).filter(|page| *page == DrillContext::Exercise);
        self.pages = [DrillContext::Library, DrillContext::Result].into_iter().chain(opened).collect();
        Some(effect)
    }

    /// Opens an exercise, or what was left of its run, game or match.
    fn open_exercise(&mut self, exercise: Exercise) -> Effect {
        // A free repetition has no end for which its player must stay.
        let goes_on = |left: &Session| left.goal != Goal::Free || left.skill == self.player.skill;
        let is_left = |left: &Session| left.repeats(&exercise) && goes_on(left);
        let Some(place) = self.unfinished_sessions.iter().position(is_left) else {
            let goal = self.options.goals.get(&exercise.name).copied().unwrap_or(Goal::Free);
            return self.begin(goal, vec![exercise]);
        };
        let left = self.unfinished_sessions.remove(place);
        let inning = left.inning_words().map(|inning| format!(", {inning}"));
        let after = inning.unwrap_or_else(|| format!(" after {} played", left.attempts.len()));
        let what = left.score_words().unwrap_or_else(|| left.goal.words());
        let effect = self.keeping_options(|page| Effect::Drill(page.practise(left)));
        self.message = Some(Message::plain(format!("{what}: it goes on here{after}")));
        effect
    }

    /// Starts a session of these exercises and opens the page of the first one.
    fn begin(&mut self, goal: Goal, exercises: Vec<Exercise>) -> Effect {
        let session = self.new_session(goal, exercises);
        Effect::Drill(self.practise(session))
    }

    /// Creates a session of these exercises with the present player and options.
    pub(super) fn new_session(&mut self, goal: Goal, exercises: Vec<Exercise>) -> Session {
        let seed = self.seed();
        let mut session = Session::new(goal, Venue::Program, exercises, self.player.skill, seed);
        // The expected scores of an exam hold only for the tables and positions of its exercises.
        if goal != Goal::Exam {
            session.shifted = self.options.shifted;
            session.table.clone_from(&self.own_table);
        }
        session
    }

    /// Opens the page of the next exercise of a session. Returns the background tasks for it.
    pub(super) fn practise(&mut self, session: Session) -> Vec<DrillTask> {
        if !session.is_exam() {
            // The options hold on, even if this session is resumed from an earlier run of the program.
            self.options.shifted = session.shifted;
            self.options.goals.extend(session.exercise().map(|exercise| (exercise.name.clone(), session.goal)));
        }
        match Turn::new(session) {
            Ok(Some(mut turn)) => {
                turn.jumps = self.jumps;
                self.pages = vec![DrillContext::Library, DrillContext::Exercise];
                return self.turn.insert(turn).request_model_shot();
            }
            Ok(None) => {}
            Err(error) => self.message = Some(Message::warning(error.to_string())),
        }
        Vec::new()
    }

    fn begin_exam(&mut self, level: u8) -> Option<Effect> {
        let seed = self.seed();
        let category = self.catalogue.filter.category;
        match exam::draw(self.catalogue.library.exercises(), level, category, seed) {
            Ok(exercises) => {
                let effect = self.begin(Goal::Exam, exercises);
                // A page describes the exam before it begins, so that the key that chose it cannot play a stroke.
                if self.page() == DrillContext::Exercise {
                    self.exam_level = level;
                    self.pages = vec![DrillContext::Library, DrillContext::Exam];
                }
                Some(effect)
            }
            Err(error) => self.refuse(error),
        }
    }

    /// Opens the page of the filmed shot that is `shots` after the marked one, and requests the fit of its stroke.
    fn open_film(&mut self, shots: isize) -> Option<Effect> {
        let Some(filmed) = self.film.select(shots) else {
            let end = if shots > 0 { "last" } else { "first" };
            self.message = Some(Message::plain(format!("this is the {end} filmed shot")));
            return None;
        };
        if self.page() != DrillContext::Film {
            self.pages.push(DrillContext::Film);
        }
        Some(Effect::Drill(vec![DrillTask::Film(Box::new(filmed))]))
    }

    fn open_records(&mut self) -> Effect {
        self.pages.push(DrillContext::Record);
        // Games and matches that start from an exercise do not count as repetitions of it.
        let is_repeated = |turn: &&Turn| !turn.session.is_exam() && !turn.session.is_game();
        let name = self.turn.as_ref().filter(is_repeated).map(|turn| turn.exercise.name.clone());
        self.records.open(name);
        // Another instance of the program may have recorded something.
        Effect::Drill(vec![self.load()])
    }

    fn share(&mut self) -> Option<Effect> {
        let exercise = self.catalogue.marked()?;
        match encode(exercise) {
            Ok(code) => {
                self.message = Some(Message::plain(format!(
                    "{code} is copied where the terminal allows it; carom drill share {} prints it",
                    exercise.name
                )));
                Some(Effect::Copy(code))
            }
            Err(error) => self.refuse(error),
        }
    }

    fn send_to_coach(&mut self) {
        let turn = self.turn.as_ref().map(|turn| TransferredPosition {
            table: turn.table.clone(),
            layout: turn.layout,
            rule: turn.exercise.rule,
            cue_ball: turn.cue_ball,
        });
        let marked = || {
            let exercise = self.catalogue.marked()?;
            let Exercise { layout, rule, .. } = *exercise;
            let table = exercise.table_with(self.own_table.as_deref());
            let found = table.map(|table| TransferredPosition { table, layout, rule, cue_ball: CueBall::White });
            Some(found.map_err(|error| error.to_string()))
        };
        let is_film = matches!(self.page(), DrillContext::Films | DrillContext::Film);
        let filmed = self.film.marked().filter(|_| is_film).map(|listed| TransferredPosition {
            table: film::table().clone(),
            layout: listed.layout,
            rule: Rule::ThreeCushion,
            cue_ball: CueBall::White,
        });
        match filmed.or(turn).map(Ok).or_else(marked) {
            Some(Ok(found)) => self.position_for_coach = Some(found),
            Some(Err(sentence)) => self.message = Some(Message::warning(sentence)),
            None => {}
        }
    }

    fn decline_answer(&mut self) {
        if let Some(Question::Search { before, marked, .. }) = self.question.take() {
            self.catalogue.search(&before);
            self.catalogue.mark_named(&marked);
        }
    }

    fn accept_answer(&mut self) -> Option<Effect> {
        let save =
            |exercise: Box<Exercise>, replace| Some(Effect::Drill(vec![DrillTask::SavePosition(exercise, replace)]));
        let question = self.question.take()?;
        let answer = match &question {
            Question::Search { .. } => {
                if self.catalogue.matches_elsewhere() > 0 {
                    self.catalogue.search_everywhere();
                }
                return None;
            }
            Question::Code(typed) => self.decoded(typed.text()).map(|exercise| save(exercise, false)),
            Question::Stroke(typed) => {
                let tasks = self.turn.as_mut()?.set_stroke_in_words(typed.text());
                tasks.map(tasks_effect).map_err(|error| error.to_string())
            }
            Question::Replace(exercise) => return save(exercise.clone(), true),
            Question::Remove(name) => return Some(Effect::Drill(vec![DrillTask::RemovePosition(name.clone())])),
            Question::Leave(..) => {
                self.unfinished_exam = self.unfinished().cloned();
                self.leave_page();
                let kept = self
                    .unfinished_exam
                    .as_ref()
                    .map(|_| "the exam is kept; c on the coach's page (F2) goes on with it");
                self.message = kept.map(Message::plain);
                return self.retry();
            }
            Question::Discard(..) => {
                self.leave_page();
                self.message = Some(Message::plain("the exam is discarded; what was played of it stays in the record"));
                return self.retry();
            }
            Question::GiveUp(Action::BeginMatch, ..) => return self.begin_match(),
            Question::GiveUp(action, ..) => return self.act(*action),
        };
        answer.unwrap_or_else(|sentence| {
            // The typed text stays for a correction.
            self.question = Some(question);
            self.refuse(sentence)
        })
    }

    fn decoded(&self, typed: &str) -> Result<Box<Exercise>, String> {
        let exercise = decode(typed).map_err(|error| error.to_string())?;
        if self.catalogue.library.is_bundled(&exercise.name) {
            return Err(format!("{} is the name of a bundled exercise; take another", exercise.name));
        }
        Ok(Box::new(Exercise { category: Category::Own, ..exercise }))
    }
}
