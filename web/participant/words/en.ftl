# What the participant's page says by itself; a study's own texts are in its study file.

# Pages that end or hold up a visit
kept = Answers you have given are stored or kept in this browser; reloading goes on from there.
reload = Reload the page
stopped-title = The study has stopped
stopped = Something in this page went wrong. If reloading does not help, please open the link in another browser.
no-study-title = There is no such study
no-study = Please check the link you were given, or ask the person who sent it to you.
finished-title = This study has been finished
finished = It has been finished with this link already, and can be taken once. Its code is shown in the browser where it was finished.
begun-elsewhere-title = This study has been begun
begun-elsewhere = It has been begun with this link already, and can be taken once. Please go on in the browser where it was begun.
link-title = This link can't be used
link = What the link says of you can't be stored. Please ask the person who sent it to you for another.
moved-title = Continued in another tab
moved = You went on with this study in another tab or window. You can close this one.
elsewhere-title = This study is open in another tab
elsewhere = Please go on there, or continue in this one from where you are.
elsewhere-continue = Continue here
updated-title = Please reload this page
updated = This study has been updated since this page was loaded, and the page can't show its next pictures.
display-title = This display can't show the next pictures
display-other = Please open the link you were given in another browser or on another device.

# Consent
consent-title = Your consent
consent-minutes =
    { $minutes ->
        [one] It takes about one minute.
       *[other] It takes about { $minutes } minutes.
    }
consent-print = Print this page
consent-decline = If you would rather not take part, close this page: nothing has been stored.
language-switch = Language
consent-agree = I agree and take part

# Instructions
instructions-title = How it works
instructions-start = Start
key-or = or
kind-two-alternative = Two pictures at once
kind-two-interval = Two pictures, one after the other
key-left = left image
key-right = right image
key-first = first
key-second = second
key-upper = upper image
key-lower = lower image
how-pair-touch = Touch the picture that you choose.
how-pair-click = Click the picture that you choose, or press its key.
how-interval-touch = Touch the button of the picture that you choose.
how-interval-click = Click the button of the picture that you choose, or press its key.

# Trials
position = { $number } of { $all }
position-growing = { $number } of at most { $most }
choice-left = Left image
choice-right = Right image
choice-first = First
choice-second = Second
spoken-first = First image
spoken-second = Second image
spoken-choose = Please choose: first or second
refresh-unknown = This browser does not tell how often its display redraws, and the pictures of this study are timed.
refresh-missed = This study shows something for { $ms } ms, and this display redraws only every { NUMBER($period_ms, minimumFractionDigits: 1, maximumFractionDigits: 1) } ms.

# Waiting
pictures-coming = The pictures are on their way: { $here } of { $of } are here ({ NUMBER($mb, minimumFractionDigits: 1, maximumFractionDigits: 1) } MB).
pictures-slow = The pictures take longer to arrive. Nothing is lost; it goes on by itself.
picture-missing = The plan of this study names a picture that it does not have.
picture-refused = The server does not give out a picture (status { $status }).
picture-damaged = A picture arrived with other bytes than the study's plan says.
line-down = No connection. Nothing is lost: this page goes on by itself when it is back.
server-busy = The server is busy. Nothing is lost: this page goes on by itself in a moment.
not-ready = The pictures of this study are being made. This page goes on by itself when they are there.
stimuli-failed = The pictures of this study could not be made. This page goes on by itself when they are there; you can also come back later.
deciding-title = One moment
deciding = The next pictures depend on your answers: they come once these are stored.
finishing-title = Almost done
finishing = The study ends once your last answers are stored.
answers-kept = No connection. Your answers are kept here and sent later; you can go on.
answers-kept-waiting = No connection. Your answers are kept here and sent later; this page goes on by itself when it is back.
answers-held = No connection. Please keep this page open; your answers are sent later.
answers-held-waiting = No connection. Please keep this page open; your answers are sent later, and this page goes on by itself when it is back.
answers-refused = An answer could not be stored yet. It is kept here; you can go on.
answers-refused-waiting = An answer could not be stored yet. It is kept here.
missing-title = One thing is missing
missing =
    { $count ->
        [one] One answer could not be stored, so there is no completion code yet. Nothing is lost: it is kept in this browser.
       *[other] { $count } answers could not be stored, so there is no completion code yet. Nothing is lost: they are kept in this browser.
    }
missing-report = If trying again does not help, please send the researchers this text: { $reasons } Session { $session }.
try-again = Try again

# The end
thanks-title = Thank you
code-label = Your completion code
code-stored = All your answers are stored. Your completion code:
code-copy = Copy the code
code-copied = Copied
code-select = Please select the code and copy it
about-title = What this study is about
return-to = Return to { $host }

# Whose visit it is
begun-title = Welcome back
begun = This study was begun in this browser and is not finished.
begun-continue = I began it: go on
someone-else = I am someone else
someone-else-note = If that was someone else, begin anew: what they have answered stays theirs.
next-person = Back to the start, for the next person
gone-title = This session has ended
gone = The server does not know this session any more. Please reload the page to begin anew, or tell the person who sent you the link.
answer-other = You were away for long, and other pictures have been chosen for you meanwhile. Please choose again.

# Networks and old browsers
line-foreign = Something between this browser and the study answers in its place, such as the sign-in page of a network. Nothing is lost: this page goes on by itself when it is gone.
answer-again = An answer could not be stored, so its pictures are here once more. Please choose again.
pictures-again = A picture came damaged, so these pictures are here once more. Please choose again.
too-old = This browser is too old for this study. Please open the link in a newer one: { $browsers }, or later.
not-loaded = This page could not be loaded in full. Please check the connection and reload it.
no-script = This study needs JavaScript. Please switch it on for this page, or open the link in another browser.

# Trying a study
trying-preview = Preview: nothing is stored.
trying-pilot = Pilot: answers are stored, and left out of every analysis.
trying-restart = Start again
